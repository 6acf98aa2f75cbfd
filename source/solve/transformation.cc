#include "solve/transformation.h"

#include <algorithm>
#include <utility>

namespace Nodus
{
  namespace
  {
    CouplingMatrix make_matrix(const std::vector<std::pair<unsigned int, NodeRow>> &rows,
                               const unsigned int                                   n_owned,
                               const Ownership                                     &displacements)
    {
      const Ownership          range(dim * n_owned, displacements.communicator());
      std::vector<MatrixEntry> entries;
      for (unsigned int k = 0; k < n_owned; ++k)
        append_entries(entries, range.begin() + dim * k, rows[k].second);
      return CouplingMatrix(entries, range, displacements);
    }
  } // namespace

  void append_entries(std::vector<MatrixEntry> &entries, const DoFIndex first, const NodeRow &row)
  {
    for (unsigned int c = 0; c < dim; ++c)
      for (const auto &[node, block] : row)
        for (unsigned int d = 0; d < dim; ++d)
          if (const double value = block[dim * c + d]; value != 0.)
            entries.push_back({first + c, dim * node + d, value});
  }

  Transformation::Transformation(std::vector<std::pair<unsigned int, NodeRow>> rows,
                                 const unsigned int                            n_owned,
                                 const Ownership                              &displacements)
      : rows_(std::move(rows))
      , n_owned_(n_owned)
      , T_(make_matrix(rows_, n_owned_, displacements))
      , values_(dim * n_owned_)
      , kept_(dim * n_owned_)
  {
  }

  void Transformation::apply(double *const x) const
  {
    std::fill(values_.begin(), values_.end(), 0.);
    T_.add_product(x, values_.data());
    for (unsigned int k = 0; k < n_owned_; ++k)
      for (unsigned int c = 0; c < dim; ++c)
        kept_[dim * k + c] = std::exchange(x[dim * rows_[k].first + c], values_[dim * k + c]);
  }

  void Transformation::restore(double *const x) const
  {
    for (unsigned int k = 0; k < n_owned_; ++k)
      std::copy_n(&kept_[dim * k], dim, x + dim * rows_[k].first);
  }

  void Transformation::apply_transposed(double *const f) const
  {
    for (unsigned int k = 0; k < n_owned_; ++k)
      for (unsigned int c = 0; c < dim; ++c)
        values_[dim * k + c] = std::exchange(f[dim * rows_[k].first + c], 0.);
    T_.add_transposed_product(values_.data(), f);
  }
} // namespace Nodus
