#include "solve/coupling_matrix.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Nodus
{
  CouplingMatrix::CouplingMatrix(const std::vector<MatrixEntry> &entries,
                                 const Ownership                &range,
                                 const Ownership                &domain)
      : communicator_(range.communicator())
  {
    constexpr std::uint32_t    none = static_cast<std::uint32_t>(-1);
    std::vector<std::uint32_t> column_of(domain.end() - domain.begin(), none); // owned ones
    std::vector<DoFIndex>      ghosts;
    const auto                 owned = [&](const DoFIndex c) { return c >= domain.begin() && c < domain.end(); };
    for (const MatrixEntry &e : entries)
      if (owned(e.column))
        column_of[e.column - domain.begin()] = 0;
      else
        ghosts.push_back(e.column);
    for (std::uint32_t i = 0; i < column_of.size(); ++i)
      if (column_of[i] != none)
      {
        column_of[i] = columns_.size();
        columns_.push_back(domain.begin() + i);
        position_.push_back(i);
      }
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    const std::size_t n_owned = columns_.size();
    columns_.insert(columns_.end(), ghosts.begin(), ghosts.end());
    at_columns_.resize(columns_.size());
    exchange_ = GhostExchange::numbered_through(domain.start(), ghosts, communicator_);

    column_.reserve(entries.size());
    value_.reserve(entries.size());
    for (const MatrixEntry &e : entries)
    {
      if (rows_.empty() || rows_.back() != e.row - range.begin())
      {
        rows_.push_back(e.row - range.begin());
        start_.push_back(column_.size());
      }
      column_.push_back(owned(e.column)
                            ? column_of[e.column - domain.begin()]
                            : n_owned + (std::lower_bound(ghosts.begin(), ghosts.end(), e.column) - ghosts.begin()));
      value_.push_back(e.value);
    }
    start_.push_back(column_.size());
  }

  const double *CouplingMatrix::at_columns(const double *const x) const
  {
    for (std::size_t c = 0; c < position_.size(); ++c)
      at_columns_[c] = x[position_[c]];
    exchange_.fetch(x, at_columns_.data() + position_.size());
    return at_columns_.data();
  }

  void CouplingMatrix::add_product(const double *const x, double *const y, const double factor) const
  {
    const double *const values = at_columns(x);
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      double sum = 0.;
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
        sum += value_[k] * values[column_[k]];
      y[rows_[i]] += factor * sum;
    }
  }

  void CouplingMatrix::add_transposed_product(const double *const x, double *const y, const double factor) const
  {
    std::fill(at_columns_.begin(), at_columns_.end(), 0.);
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      const double xi = factor * x[rows_[i]];
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
        at_columns_[column_[k]] += value_[k] * xi;
    }
    for (std::size_t c = 0; c < position_.size(); ++c)
      y[position_[c]] += at_columns_[c];
    exchange_.add(at_columns_.data() + position_.size(), y);
  }

  void CouplingMatrix::scale_rows(const std::vector<double> &factor)
  {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k)
        value_[k] *= factor[rows_[i]];
  }

  void CouplingMatrix::scale_columns(const std::vector<double> &factor)
  {
    const double *const factors = at_columns(factor.data());
    for (std::size_t k = 0; k < value_.size(); ++k)
      value_[k] *= factors[column_[k]];
  }

  double CouplingMatrix::norm_squared() const
  {
    double sum = 0.;
    for (const double value : value_)
      sum += value * value;
    return dealii::Utilities::MPI::sum(sum, communicator_);
  }
} // namespace Nodus
