#include "solve/multigrid/transfer.h"
#include "solve/mode_panel.h"
#include "solve/multigrid/galerkin_product.h"

#include <algorithm>

namespace Nodus
{
  using ModePanel::Modes;

  namespace
  {
    /// Blocks of P to be fetched from memory ahead of their use.
    constexpr unsigned int ahead = 64;
  } // namespace

  Transfer::Transfer(const NodeMap &nodes)
      : communicator_(nodes.communicator())
      , n_nodes_(nodes.n_owned())
  {
  }

  void Transfer::prepare_exchange()
  {
    exchange_ = GhostExchange::numbered_through(P_.aggregates.starts, P_.aggregates.ghosts, communicator_);
    ghost_values_.resize(n_modes * P_.aggregates.ghosts.size());
    for (std::uint32_t i = 0; i < n_nodes_; ++i)
      if (std::any_of(P_.column.begin() + P_.start[i],
                      P_.column.begin() + P_.start[i + 1],
                      [this](const std::uint32_t a) { return a >= P_.aggregates.n_owned; }))
        interface_.push_back(i);
  }

  template <typename Function>
  void Transfer::for_interior_rows(const Function &f) const
  {
    auto next = interface_.begin();
    for (std::uint32_t i = 0; i < n_nodes_; ++i)
      if (next != interface_.end() && *next == i)
        ++next;
      else
        f(i);
  }

  std::unique_ptr<BlockCsrMatrix> Transfer::make_coarse_matrix(const BlockCsrMatrix    &K,
                                                               const ConstrainedMatrix &A) const
  {
    return galerkin_product(K, A, P_);
  }

  void Transfer::restrict_to(double *const coarse, const double *const fine) const
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

  void Transfer::add_prolongation(double *const fine, const double *const coarse) const
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
