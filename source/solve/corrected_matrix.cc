#include <nodus/solve/corrected_matrix.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstring>

namespace Nodus
{
  namespace
  {
    std::vector<DoFIndex> columns(const std::vector<MatrixEntry> &entries)
    {
      std::vector<DoFIndex> nodes;
      nodes.reserve(entries.size() / dim);
      for (const MatrixEntry &e : entries)
        if (nodes.empty() || nodes.back() != e.column / dim)
          nodes.push_back(e.column / dim);
      return nodes;
    }
  } // namespace

  CorrectedMatrix::CorrectedMatrix(const NodeMatrix               &K,
                                   std::vector<char>               taken_out,
                                   const std::vector<MatrixEntry> &correction,
                                   CorrectionFactors               factors)
      : taken_out_(std::move(taken_out))
      , nodes_(K.map(), columns(correction))
      , pattern_(K.pattern())
      , factors_(std::move(factors))
      , stiffness_(K.values().begin(), K.values().end())
      , springs_(dim * factors_.D.size())
  {
    for (unsigned int i = 0; i < nodes_.n_owned() && !factors_.T; ++i)
      for (std::size_t k = pattern_->start[i]; k < pattern_->start[i + 1]; ++k)
        if (taken_out_[i] || taken_out_[pattern_->column[k]])
          std::fill_n(stiffness_.begin() + 9 * k, 9, 0.F);

    start_.assign(nodes_.n_owned() + 1, 0);
    for (auto entry = correction.begin(); entry != correction.end();)
    {
      const DoFIndex node = entry->row / dim;
      const auto     last =
          std::find_if(entry, correction.end(), [&](const MatrixEntry &e) { return e.row / dim != node; });
      const unsigned int i      = nodes_.local(node);
      const std::size_t  first  = column_.size();
      DoFIndex           column = dealii::numbers::invalid_dof_index; // of the entry before: up to three in a row
      for (auto e = entry; e != last; ++e)
        if (e->column / dim != column)
        {
          column = e->column / dim;
          column_.push_back(nodes_.local(column));
        }
      std::sort(column_.begin() + first, column_.end());
      column_.erase(std::unique(column_.begin() + first, column_.end()), column_.end());
      values_.resize(9 * column_.size(), 0.F);
      float *block = nullptr;
      column       = dealii::numbers::invalid_dof_index;
      for (auto e = entry; e != last; ++e)
      {
        if (e->column / dim != column)
        {
          column = e->column / dim;
          block  = &values_[9 * (std::lower_bound(column_.begin() + first, column_.end(), nodes_.local(column)) -
                                column_.begin())];
        }
        block[dim * (e->row % dim) + e->column % dim] += e->value;
      }
      start_[i + 1] = column_.size() - first;
      rows_.push_back(i);
      entry = last;
    }
    values_.resize(9 * column_.size() + 3, 0.F); // for reading in vectors of four
    values_.shrink_to_fit();
    for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
      start_[i + 1] += start_[i];
  }

  void CorrectedMatrix::vmult_by_factors(double *const y, double *const x) const
  {
    factors_.T->apply(x);
    pattern_->vmult(stiffness_.data(), y, nodes_.with_ghosts(x));
    factors_.T->restore(x);
    factors_.T->apply_transposed(y);

    std::fill(springs_.begin(), springs_.end(), 0.);
    factors_.R->add_product(x, springs_.data());
    for (std::size_t k = 0; k < factors_.D.size(); ++k)
    {
      Eigen::Map<Eigen::Vector3d> values(&springs_[dim * k]);
      values = (Eigen::Map<const Eigen::Matrix3d>(factors_.D[k].data()) * values).eval();
    }
    factors_.R->add_transposed_product(springs_.data(), y);
    for (const auto &[i, d] : factors_.d)
      y[i] = d * x[i];
  }

  void CorrectedMatrix::vmult(double *const y, double *const x_owned) const
  {
    if (factors_.T)
    {
      vmult_by_factors(y, x_owned);
      return;
    }
    const NodeValues x = nodes_.with_ghosts(x_owned);
    pattern_->vmult(stiffness_.data(), y, x);
    // rows of a block in vectors of four, as in NodePattern::vmult()
    typedef double Lanes __attribute__((vector_size(32)));
    const auto     row = [](const float *values)
    {
      typedef float Stored __attribute__((vector_size(16)));
      Stored        stored;
      std::memcpy(&stored, values, sizeof(Stored));
      return __builtin_convertvector(stored, Lanes);
    };
    for (const unsigned int i : rows_)
    {
      Lanes        sum[dim] = {};
      const float *a        = values_.data() + 9 * std::size_t(start_[i]);
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k, a += 9)
      {
        const double *const xj = x[column_[k]];
        const Lanes         xk = {xj[0], xj[1], xj[2], 0.};
        for (unsigned int c = 0; c < dim; ++c)
          sum[c] += row(a + dim * c) * xk;
      }
      for (unsigned int c = 0; c < dim; ++c)
        y[dim * i + c] += sum[c][0] + sum[c][1] + sum[c][2];
    }
  }
} // namespace Nodus
