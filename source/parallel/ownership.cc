#include "parallel/ownership.h"
#include "parallel/all_gather.h"
#include "parallel/sparse_exchange.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace Nodus
{
  Ownership::Ownership(const dealii::IndexSet &owned, const MPI_Comm communicator)
      : Ownership(static_cast<unsigned int>(owned.n_elements()), communicator)
  {
    if (!owned.is_ascending_and_one_to_one(communicator))
      throw SolverFailure("Krylov solver: each rank must own one range of unknowns, in the order of the ranks.");
  }

  Ownership::Ownership(const unsigned int n_owned, const MPI_Comm communicator)
      : start_(1, 0)
      , communicator_(communicator)
      , rank_(dealii::Utilities::MPI::this_mpi_process(communicator))
  {
    for (const unsigned int n : all_gather(communicator, n_owned))
      start_.push_back(start_.back() + n);
  }

  unsigned int Ownership::owner(const DoFIndex i) const
  {
    return std::upper_bound(start_.begin(), start_.end(), i) - start_.begin() - 1;
  }

  Ownership Ownership::times(const unsigned int factor) const
  {
    Ownership result(*this);
    for (DoFIndex &i : result.start_)
      i *= factor;
    return result;
  }

  dealii::IndexSet Ownership::owned() const
  {
    dealii::IndexSet result(start_.back());
    result.add_range(begin(), end());
    return result;
  }

  /// By row and column: into rows first, which are short.
  void Ownership::sort(std::vector<MatrixEntry> &entries) const
  {
    const auto by_place = [](const MatrixEntry &a, const MatrixEntry &b)
    { return a.row < b.row || (a.row == b.row && a.column < b.column); };
    if (std::is_sorted(entries.begin(), entries.end(), by_place))
      return;
    std::vector<std::size_t> start(end() - begin() + 1, 0);
    for (const MatrixEntry &e : entries)
      ++start[e.row - begin() + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::size_t> next(start);
    std::vector<MatrixEntry> sorted(entries.size());
    for (const MatrixEntry &e : entries)
      sorted[next[e.row - begin()]++] = e;
    for (std::size_t i = 0; i + 1 < start.size(); ++i)
      std::sort(sorted.begin() + start[i],
                sorted.begin() + start[i + 1],
                [](const MatrixEntry &a, const MatrixEntry &b) { return a.column < b.column; });
    entries = std::move(sorted);
  }

  std::vector<MatrixEntry> Ownership::exchange(std::vector<MatrixEntry> entries) const
  {
    const auto first = std::partition(
        entries.begin(), entries.end(), [&](const MatrixEntry &e) { return e.row >= begin() && e.row < end(); });
    std::map<unsigned int, std::vector<MatrixEntry>> outgoing;
    for (auto e = first; e != entries.end(); ++e)
      outgoing[owner(e->row)].push_back(*e);
    entries.erase(first, entries.end());
    for (const auto &[source, received] : sparse_exchange(communicator_, outgoing))
      entries.insert(entries.end(), received.begin(), received.end());

    sort(entries);
    std::size_t n = 0;
    for (const MatrixEntry &e : entries)
      if (n > 0 && entries[n - 1].row == e.row && entries[n - 1].column == e.column)
        entries[n - 1].value += e.value;
      else
        entries[n++] = e;
    entries.resize(n);
    return entries;
  }
} // namespace Nodus
