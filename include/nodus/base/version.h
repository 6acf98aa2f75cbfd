#ifndef nodus_base_version_h
#define nodus_base_version_h

/// CMakeLists.txt reads it from here. Before 1.0 the interface may change with the second number.
#define NODUS_VERSION "0.1.0"

#endif
