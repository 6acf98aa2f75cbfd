#include "solve/coupled_unknowns.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Nodus
{
  void CoupledUnknowns::find(const int               size,
                             const std::vector<int> &rows,
                             const std::vector<int> &columns,
                             const MPI_Comm          communicator)
  {
    number_.assign(size, 0);
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k] != columns[k])
        number_[rows[k] - 1] = number_[columns[k] - 1] = 1;
    dealii::Utilities::MPI::max(number_, communicator, number_);
    if (std::find(number_.begin(), number_.end(), 1) == number_.end())
      number_[0] = 1;
    coupled_.clear();
    for (int i = 0; i < size; ++i)
      if (number_[i] > 0)
      {
        coupled_.push_back(i);
        number_[i] = this->size();
      }
    row.resize(rows.size());
    column.resize(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
      row[k]    = number_[rows[k] - 1];
      column[k] = number_[columns[k] - 1];
    }
  }

  void CoupledUnknowns::take_diagonal(const std::vector<int>    &rows,
                                      const std::vector<double> &value,
                                      const MPI_Comm             communicator)
  {
    diagonal_.assign(number_.size(), 0.);
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (row[k] == 0)
        diagonal_[rows[k] - 1] += value[k];
    dealii::Utilities::MPI::sum(diagonal_, communicator, diagonal_);
  }

  std::vector<double> CoupledUnknowns::part(const std::vector<double> &x) const
  {
    std::vector<double> y;
    y.reserve(coupled_.size());
    for (const int i : coupled_)
      y.push_back(x[i]);
    return y;
  }

  void CoupledUnknowns::solve(const std::vector<double> &y, std::vector<double> &x) const
  {
    for (std::size_t i = 0; i < x.size(); ++i)
      if (number_[i] > 0)
        x[i] = y[number_[i] - 1];
      else
        x[i] = diagonal_[i] != 0. ? x[i] / diagonal_[i] : 0.;
  }

  int CoupledUnknowns::n_negative() const
  {
    return static_cast<int>(std::count_if(diagonal_.begin(), diagonal_.end(), [](const double d) { return d < 0.; }));
  }

  std::vector<int> CoupledUnknowns::null_pivots() const
  {
    std::vector<int> pivots;
    for (std::size_t i = 0; i < number_.size(); ++i)
      if (number_[i] == 0 && diagonal_[i] == 0.)
        pivots.push_back(static_cast<int>(i));
    return pivots;
  }
} // namespace Nodus
