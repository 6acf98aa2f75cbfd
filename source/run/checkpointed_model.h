#ifndef nodus_run_checkpointed_model_h
#define nodus_run_checkpointed_model_h

#include <nodus/parameters/parameters.h>

#include <map>
#include <string>

namespace Nodus
{
  /// Keys and values of the model that a checkpoint belongs to. Names and places of files may change, their contents
  /// may not: a checksum stands for them.
  std::map<std::string, std::string> checkpointed_model(const Parameters &parameters);

  /// In what two models have different pasts at time @p t: a clause that names the key and its values; empty where a
  /// restart may go from one to the other. Conditions and contact pairs that begin to act at that time or later may
  /// differ (pairs but for what their sites follow from), and when those that act will cease to.
  std::string first_difference(const std::map<std::string, std::string> &then,
                               const std::map<std::string, std::string> &now,
                               double                                    t);
} // namespace Nodus

#endif
