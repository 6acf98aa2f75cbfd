#include "solve/block_csr_rows.h"

#include <algorithm>
#include <utility>

namespace Nodus
{
  namespace
  {
    void add_product(double *y, const double *a, const bool transposed, const double *x)
    {
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int d = 0; d < dim; ++d)
          y[c] += (transposed ? a[dim * d + c] : a[dim * c + d]) * x[d];
    }
  } // namespace

  BlockCsrRows::BlockCsrRows(const BlockCsrMatrix &matrix, std::vector<unsigned int> nodes)
      : matrix_(matrix)
      , nodes_(std::move(nodes))
  {
    const unsigned int n_owned = matrix.map().n_owned();
    for (const unsigned int i : nodes_)
      if (i >= n_owned)
        ghosts_.push_back(i);
      else
        matrix.for_row(i,
                       [&](const unsigned int j, const double *, bool)
                       {
                         if (j >= n_owned)
                           ghosts_.push_back(j);
                       });
    std::sort(ghosts_.begin(), ghosts_.end());
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
    exchange_ = matrix.map().exchange_for(ghosts_);
    received_.resize(dim * ghosts_.size());
    ghost_values_.resize(dim * (matrix.map().size() - n_owned));
  }

  NodeValues BlockCsrRows::with_ghosts(const double *const x) const
  {
    const unsigned int n_owned = matrix_.map().n_owned();
    exchange_.fetch(x, received_.data(), dim);
    for (std::size_t g = 0; g < ghosts_.size(); ++g)
      std::copy_n(&received_[dim * g], dim, &ghost_values_[dim * std::size_t(ghosts_[g] - n_owned)]);
    return {x, ghost_values_.data(), n_owned};
  }

  void BlockCsrRows::vmult(double *const y, const double *const x_owned) const
  {
    const NodeValues x = with_ghosts(x_owned);
    for (const unsigned int i : nodes_)
      if (i < x.n_owned)
      {
        std::fill_n(y + dim * i, dim, 0.);
        matrix_.for_row(i,
                        [&](const unsigned int j, const double *const block, const bool transposed)
                        { add_product(y + dim * i, block, transposed, x[j]); });
      }
  }

  void BlockCsrRows::vmult_columns(double *const y, const double *const x_owned) const
  {
    const NodeValues x = with_ghosts(x_owned);
    std::fill_n(y, dim * x.n_owned, 0.);
    const NodePattern  &p      = *matrix_.pattern();
    const double *const values = matrix_.values().data();
    for (const unsigned int j : nodes_)
    {
      for (std::uint32_t k = p.lower_start[j]; k < p.lower_start[j + 1]; ++k)
        add_product(y + dim * p.lower[k].row, values + 9 * std::size_t(p.lower[k].block), false, x[j]);
      if (j < x.n_owned)
        for (std::uint32_t k = p.start[j]; k < p.ghosts[j]; ++k)
          add_product(y + dim * p.column[k], values + 9 * std::size_t(k), true, x[j]);
    }
  }
} // namespace Nodus
