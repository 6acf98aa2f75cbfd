#include <nodus/memory.h>

#include <cstdint>

#ifdef __GLIBC__
#  include <link.h>
#  include <malloc.h>
#  include <sys/mman.h>
#  include <unistd.h>
#endif

namespace Nodus
{
#ifdef __GLIBC__
  namespace
  {
    int give_back_read_only_segments(dl_phdr_info *const library, std::size_t, void *)
    {
      const std::uintptr_t page = sysconf(_SC_PAGESIZE);
      for (unsigned int i = 0; i < library->dlpi_phnum; ++i)
      {
        const auto &segment = library->dlpi_phdr[i];
        if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W))
          continue;
        const std::uintptr_t start = library->dlpi_addr + segment.p_vaddr, first = (start + page - 1) / page * page,
                             last = (start + segment.p_memsz) / page * page;
        if (last > first)
          madvise(reinterpret_cast<void *>(first), last - first, MADV_DONTNEED); // no harm if it fails
      }
      return 0;
    }
  } // namespace

  void give_back_memory()
  {
    malloc_trim(0);
    dl_iterate_phdr(give_back_read_only_segments, nullptr);
  }
#else
  void give_back_memory()
  {
  }
#endif
} // namespace Nodus
