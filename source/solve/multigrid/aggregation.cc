#include "solve/multigrid/aggregation.h"
#include "parallel/all_gather.h"
#include "solve/mode_panel.h"
#include "solve/multigrid/galerkin_product.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  using ModePanel::Modes;
  using ModePanel::none;

  namespace
  {
    /// Blocks of P to be fetched from memory ahead of their use.
    constexpr unsigned int ahead = 64;
  } // namespace

  Aggregation::Aggregation(const BlockCsrMatrix                     &K,
                           const ConstrainedMatrix                  &A,
                           std::vector<double>                       modes,
                           const std::vector<std::array<double, 9>> &D_inverse,
                           const double                              omega)
      : A_(A)
      , nodes_(A.map())
  {
    aggregate(K, modes);
    make_tentative(std::move(modes));
    smooth(K, D_inverse, omega);
    exchange_ = GhostExchange::numbered_through(P_.aggregates.starts, P_.aggregates.ghosts, nodes_.communicator());
    ghost_values_.resize(n_modes * P_.aggregates.ghosts.size());
    for (std::uint32_t i = 0; i < nodes_.n_owned(); ++i)
      if (std::any_of(P_.column.begin() + P_.start[i],
                      P_.column.begin() + P_.start[i + 1],
                      [this](const std::uint32_t a) { return a >= P_.aggregates.n_owned; }))
        interface_.push_back(i);
  }

  /// A node and its neighbours, as long as none of them is taken; the others join a neighbour's aggregate. Bodies do
  /// not mix: they slide on each other. Nodes without modes are prescribed and stay out.
  void Aggregation::aggregate(const BlockCsrMatrix &K, const std::vector<double> &modes)
  {
    const unsigned int n            = nodes_.n_owned();
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
    for (const unsigned int n_there : all_gather(nodes_.communicator(), n_aggregates))
      starts.push_back(starts.back() + n_there);
    P_.aggregates.first = starts[dealii::Utilities::MPI::this_mpi_process(nodes_.communicator())];
  }

  /// Gram-Schmidt on the modes of each aggregate; what it takes off are the modes in the coarse unknowns.
  void Aggregation::make_tentative(std::vector<double> modes)
  {
    const unsigned int                     n_aggregates = P_.aggregates.n_owned;
    const unsigned int                     n = dim * nodes_.n_owned(), n_coarse = n_modes * n_aggregates;
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

  template <typename Function>
  void Aggregation::for_interior_rows(const Function &f) const
  {
    auto next = interface_.begin();
    for (std::uint32_t i = 0; i < nodes_.n_owned(); ++i)
      if (next != interface_.end() && *next == i)
        ++next;
      else
        f(i);
  }

  std::unique_ptr<BlockCsrMatrix> Aggregation::make_coarse_matrix(const BlockCsrMatrix &K) const
  {
    return galerkin_product(K, A_, P_);
  }

  void Aggregation::restrict_to(double *const coarse, const double *const fine) const
  {
    const unsigned int n_aggregates = P_.aggregates.n_owned;
    std::fill_n(coarse, n_modes * n_aggregates, 0.);
    std::fill(ghost_values_.begin(), ghost_values_.end(), 0.);
    double *const ghosts  = ghost_values_.data();
    const auto    add_row = [&](const std::uint32_t i)
    {
      for (std::uint32_t k = P_.start[i]; k < P_.start[i + 1]; ++k)
      {
        const float *const p = P_.block(k);
        __builtin_prefetch(p + block_size * ahead);
        const std::uint32_t a      = P_.column[k];
        double *const       values = a < n_aggregates ? coarse + n_modes * a : ghosts + n_modes * (a - n_aggregates);
        Modes               sum    = Modes::load(values);
        for (unsigned int c = 0; c < dim; ++c)
          sum.add_product(Modes::load(p + n_modes * c), fine[dim * i + c]);
        sum.store(values);
      }
    };
    for (const std::uint32_t i : interface_)
      add_row(i);
    exchange_.start_add(ghosts, n_modes);
    for_interior_rows(add_row);
    exchange_.finish_add(coarse, n_modes);
  }

  void Aggregation::add_prolongation(double *const fine, const double *const coarse) const
  {
    const unsigned int  n_aggregates = P_.aggregates.n_owned;
    const double *const ghosts       = ghost_values_.data();
    const auto          add_row      = [&](const std::uint32_t i)
    {
      Modes sum[dim] = {};
      for (std::uint32_t k = P_.start[i]; k < P_.start[i + 1]; ++k)
      {
        const float *const p = P_.block(k);
        __builtin_prefetch(p + block_size * ahead);
        const std::uint32_t a = P_.column[k];
        const Modes x = Modes::load(a < n_aggregates ? coarse + n_modes * a : ghosts + n_modes * (a - n_aggregates));
        for (unsigned int c = 0; c < dim; ++c)
          sum[c].add_product(Modes::load(p + n_modes * c), x);
      }
      for (unsigned int c = 0; c < dim; ++c)
        fine[dim * i + c] += sum[c].sum();
    };
    exchange_.start_fetch(coarse, n_modes);
    for_interior_rows(add_row);
    exchange_.finish_fetch(ghost_values_.data(), n_modes);
    for (const std::uint32_t i : interface_)
      add_row(i);
  }
} // namespace Nodus
