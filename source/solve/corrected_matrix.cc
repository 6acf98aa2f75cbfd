#include <nodus/solve/corrected_matrix.h>

#include <algorithm>

namespace Nodus
{
  namespace
  {
    std::vector<DoFIndex> columns(const std::vector<MatrixEntry> &entries)
    {
      std::vector<DoFIndex> nodes;
      nodes.reserve(entries.size());
      for (const MatrixEntry &e : entries)
        nodes.push_back(e.column / dim);
      return nodes;
    }
  } // namespace

  CorrectedMatrix::CorrectedMatrix(const NodeMatrix               &K,
                                   std::vector<char>               taken_out,
                                   const std::vector<MatrixEntry> &correction)
      : taken_out_(std::move(taken_out))
      , nodes_(K.map(), columns(correction))
      , pattern_(K.pattern())
      , stiffness_(K.values().begin(), K.values().end())
  {
    for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
      for (std::size_t k = pattern_->start[i]; k < pattern_->start[i + 1]; ++k)
        if (taken_out_[i] || taken_out_[pattern_->column[k]])
          std::fill_n(stiffness_.begin() + 9 * k, 9, 0.F);

    start_.assign(nodes_.n_owned() + 1, 0);
    for (auto entry = correction.begin(); entry != correction.end();)
    {
      const DoFIndex node = entry->row / dim;
      const auto     last =
          std::find_if(entry, correction.end(), [&](const MatrixEntry &e) { return e.row / dim != node; });
      const unsigned int i     = nodes_.local(node);
      const std::size_t  first = column_.size();
      for (auto e = entry; e != last; ++e)
        column_.push_back(nodes_.local(e->column / dim));
      std::sort(column_.begin() + first, column_.end());
      column_.erase(std::unique(column_.begin() + first, column_.end()), column_.end());
      values_.resize(9 * column_.size(), 0.);
      for (auto e = entry; e != last; ++e)
      {
        const auto found = std::lower_bound(column_.begin() + first, column_.end(), nodes_.local(e->column / dim));
        values_[9 * (found - column_.begin()) + dim * (e->row % dim) + e->column % dim] += e->value;
      }
      start_[i + 1] = column_.size() - first;
      rows_.push_back(i);
      entry = last;
    }
    values_.shrink_to_fit();
    for (unsigned int i = 0; i < nodes_.n_owned(); ++i)
      start_[i + 1] += start_[i];
  }

  void CorrectedMatrix::vmult(double *const y, const double *const x_owned) const
  {
    const double *const x = nodes_.with_ghosts(x_owned);
    pattern_->vmult(stiffness_.data(), y, x);
    for (const unsigned int i : rows_)
    {
      double       *yi = y + dim * i;
      const double *a  = values_.data() + 9 * std::size_t(start_[i]);
      for (std::uint32_t k = start_[i]; k < start_[i + 1]; ++k, a += 9)
      {
        const double *xj = x + dim * column_[k];
        yi[0] += a[0] * xj[0] + a[1] * xj[1] + a[2] * xj[2];
        yi[1] += a[3] * xj[0] + a[4] * xj[1] + a[5] * xj[2];
        yi[2] += a[6] * xj[0] + a[7] * xj[1] + a[8] * xj[2];
      }
    }
  }
} // namespace Nodus
