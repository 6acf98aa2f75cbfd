#include <nodus/solve/transformation.h>

#include <algorithm>
#include <utility>

namespace Nodus
{
  Transformation::Transformation(std::vector<unsigned int>       nodes,
                                 const std::vector<MatrixEntry> &entries,
                                 const Ownership                &rows,
                                 const Ownership                &displacements)
      : nodes_(std::move(nodes))
      , T_(entries, rows, displacements)
      , values_(dim * nodes_.size())
      , kept_(dim * nodes_.size())
  {
  }

  void Transformation::apply(double *const x) const
  {
    std::fill(values_.begin(), values_.end(), 0.);
    T_.add_product(x, values_.data());
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      for (unsigned int c = 0; c < dim; ++c)
      {
        kept_[dim * k + c]    = x[dim * nodes_[k] + c];
        x[dim * nodes_[k] + c] = values_[dim * k + c];
      }
  }

  void Transformation::restore(double *const x) const
  {
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      std::copy_n(&kept_[dim * k], dim, x + dim * nodes_[k]);
  }

  void Transformation::apply_transposed(double *const f) const
  {
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      for (unsigned int c = 0; c < dim; ++c)
        values_[dim * k + c] = std::exchange(f[dim * nodes_[k] + c], 0.);
    T_.add_transposed_product(values_.data(), f);
  }
} // namespace Nodus
