#include "solve/multigrid/aggregation.h"
#include "parallel/all_gather.h"
#include "solve/mode_panel.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace Nodus
{
  using ModePanel::none;

  Aggregation::Aggregation(const BlockCsrMatrix                     &K,
                           const ConstrainedMatrix                  &A,
                           std::vector<double>                       modes,
                           const std::vector<std::array<double, 9>> &D_inverse,
                           const double                              omega)
      : Transfer(A.map())
  {
    aggregate(K, modes);
    make_tentative(std::move(modes));
    smooth(K, A, D_inverse, omega);
    prepare_exchange();
  }

  /// A node and its neighbours, as long as none of them is taken; the others join a neighbour's aggregate. Bodies do
  /// not mix: they slide on each other. Nodes without modes are prescribed and stay out.
  void Aggregation::aggregate(const BlockCsrMatrix &K, const std::vector<double> &modes)
  {
    const unsigned int n            = n_nodes_;
    unsigned int      &n_aggregates = P_.aggregates.n_owned;
    std::vector<char>  moves(n, 0);
    for (unsigned int m = 0; m < n_modes; ++m)
      for (unsigned int i = 0; i < dim * n; ++i)
        if (modes[m * dim * n + i] != 0.)
          moves[i / dim] = 1;

    aggregate_.assign(n, none);
    const auto for_neighbours = [&](const unsigned int i, const auto &f)
    {
      K.for_row(i,
                [&](const unsigned int j, const double *, const bool)
                {
                  if (j < n && j != i && moves[j])
                    f(j);
                });
    };
    const auto start = [&](const unsigned int i)
    {
      aggregate_[i] = n_aggregates;
      for_neighbours(i,
                     [&](const unsigned int j)
                     {
                       if (aggregate_[j] == none)
                         aggregate_[j] = n_aggregates;
                     });
      ++n_aggregates;
    };

    for (unsigned int i = 0; i < n; ++i)
      if (moves[i] && aggregate_[i] == none)
      {
        bool free = true;
        for_neighbours(i, [&](const unsigned int j) { free = free && aggregate_[j] == none; });
        if (free)
          start(i);
      }

    const unsigned int        n_first = n_aggregates;
    std::vector<unsigned int> size(n_first, 0);
    for (const unsigned int a : aggregate_)
      if (a != none)
        ++size[a];
    std::vector<unsigned int> joined;
    for (unsigned int i = 0; i < n; ++i)
      if (moves[i] && aggregate_[i] == none)
      {
        unsigned int best = none;
        for_neighbours(i,
                       [&](const unsigned int j)
                       {
                         const unsigned int a = aggregate_[j];
                         if (a < n_first && (best == none || size[a] < size[best]))
                           best = a;
                       });
        if (best == none)
          continue;
        // not to be seen by the nodes that follow: aggregates would grow long
        joined.push_back(i);
        aggregate_[i] = n_first + best;
        ++size[best];
      }
    for (const unsigned int i : joined)
      aggregate_[i] -= n_first;

    for (unsigned int i = 0; i < n; ++i)
      if (moves[i] && aggregate_[i] == none)
        start(i);

    std::vector<DoFIndex> &starts = P_.aggregates.starts;
    starts.assign(1, 0);
    for (const unsigned int n_there : all_gather(communicator_, n_aggregates))
      starts.push_back(starts.back() + n_there);
    P_.aggregates.first = starts[dealii::Utilities::MPI::this_mpi_process(communicator_)];
  }

  /// Gram-Schmidt on the modes of each aggregate; what it takes off are the modes in the coarse unknowns.
  void Aggregation::make_tentative(std::vector<double> modes)
  {
    const unsigned int                     n_aggregates = P_.aggregates.n_owned;
    const unsigned int                     n = dim * n_nodes_, n_coarse = n_modes * n_aggregates;
    std::vector<std::vector<unsigned int>> dofs(n_aggregates);
    for (unsigned int i = 0; i < n; ++i)
      if (aggregate_[i / dim] != none)
        dofs[aggregate_[i / dim]].push_back(i);
    tentative_ = std::move(modes);
    coarse_modes_.assign(std::max(1U, n_modes * n_coarse), 0.);
    for (unsigned int a = 0; a < n_aggregates; ++a)
    {
      const auto product = [&](const unsigned int k, const unsigned int l)
      {
        double sum = 0.;
        for (const unsigned int i : dofs[a])
          sum += tentative_[k * n + i] * tentative_[l * n + i];
        return sum;
      };
      for (unsigned int m = 0; m < n_modes; ++m)
      {
        const double before = std::sqrt(product(m, m));
        for (unsigned int pass = 0; pass < 2; ++pass)
          for (unsigned int k = 0; k < m; ++k)
          {
            const double factor = product(k, m);
            coarse_modes_[m * n_coarse + n_modes * a + k] += factor;
            for (const unsigned int i : dofs[a])
              tentative_[m * n + i] -= factor * tentative_[k * n + i];
          }
        const double norm = std::sqrt(product(m, m)), scale = norm > 1e-8 * before ? 1. / norm : 0.;
        for (const unsigned int i : dofs[a])
          tentative_[m * n + i] *= scale;
        coarse_modes_[m * n_coarse + n_modes * a + m] = scale > 0. ? norm : 0.;
      }
    }
  }
} // namespace Nodus
