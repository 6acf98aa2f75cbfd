#ifndef nodus_solve_multigrid_prolongation_h
#define nodus_solve_multigrid_prolongation_h

#include "solve/multigrid/coarse_matrix.h"
#include <nodus/base/types.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace Nodus
{
  /// The aggregates of all ranks, and those that this rank knows: its own ones come first, then others.
  struct Aggregates
  {
    unsigned int          n_owned = 0;
    std::vector<DoFIndex> starts; ///< global number of the first one of each rank, and the number of all
    DoFIndex              first = 0;
    std::vector<DoFIndex> ghosts; ///< global numbers, ascending

    /// Of owned ones and ghosts.
    unsigned int size() const
    {
      return n_owned + ghosts.size();
    }
    bool owned(const DoFIndex global) const
    {
      return global >= first && global < first + n_owned;
    }
    DoFIndex global(const unsigned int local) const
    {
      return local < n_owned ? first + local : ghosts[local - n_owned];
    }
    /// Whether it is owned or a ghost.
    bool knows(const DoFIndex global) const
    {
      return owned(global) || std::binary_search(ghosts.begin(), ghosts.end(), global);
    }
    /// Of an aggregate that is known.
    unsigned int local(const DoFIndex global) const
    {
      return owned(global) ? global - first
                           : n_owned + (std::lower_bound(ghosts.begin(), ghosts.end(), global) - ghosts.begin());
    }
  };

  /// P, rows of the owned nodes: per entry a local aggregate and three displacements by six modes, row by row. Single
  /// precision halves what a cycle reads; P^T A P belongs to the rounded P.
  struct Prolongation
  {
    static constexpr unsigned int n_modes    = CoarseRow::n_modes;
    static constexpr unsigned int block_size = dim * n_modes;

    Aggregates                 aggregates;
    std::vector<std::uint32_t> start, column;
    std::vector<float>         blocks; ///< and two more values, so that the last row can be read as a vector of eight

    const float *block(const std::size_t k) const
    {
      return blocks.data() + block_size * k;
    }
  };
} // namespace Nodus

#endif
