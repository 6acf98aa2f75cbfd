#include <nodus/solve/corrected_matrix.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>

#include <algorithm>

namespace Nodus
{
  CorrectedMatrix::CorrectedMatrix(const NodeMatrix               &K,
                                   std::vector<char>               taken_out,
                                   const std::vector<MatrixEntry> &correction)
      : Epetra_BasicRowMatrix(Epetra_MpiComm(K.map().communicator()))
      , K_(K)
      , taken_out_(std::move(taken_out))
      , takes_out_(std::find(taken_out_.begin(), taken_out_.end(), 1) != taken_out_.end())
  {
    const NodeMap    &nodes   = K.map();
    const Epetra_Map &row_map = nodes.row_map();
    E_                        = make_matrix(correction, row_map, row_map);

    // columns: owned, then the ghosts of K and of E in ascending order, so that those of one rank follow each other
    const int        n_owned = row_map.NumMyElements();
    std::vector<int> columns(row_map.MyGlobalElements(), row_map.MyGlobalElements() + n_owned);
    for (unsigned int i = nodes.n_owned(); i < nodes.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        columns.push_back(dim * nodes.global(i) + c);
    for (int k = 0; k < E_->ColMap().NumMyElements(); ++k)
      if (!row_map.MyGID(E_->GCID(k)))
        columns.push_back(E_->GCID(k));
    std::sort(columns.begin() + n_owned, columns.end());
    columns.erase(std::unique(columns.begin() + n_owned, columns.end()), columns.end());
    const Epetra_Map column_map(-1, static_cast<int>(columns.size()), columns.data(), 0, row_map.Comm());
    SetMaps(row_map, column_map);

    for (unsigned int i = nodes.n_owned(); i < nodes.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        column_of_ghost_.push_back(column_map.LID(static_cast<int>(dim * nodes.global(i) + c)));
    for (int k = 0; k < E_->ColMap().NumMyElements(); ++k)
      E_column_.push_back(column_map.LID(E_->GCID(k)));
    kept_.resize(n_owned);
    position_.assign(columns.size(), -1);
    length_.assign(n_owned, 0);
    for (int row = 0; row < n_owned; ++row)
      for_row(row, [&](const int, const double) { ++length_[row]; });
  }

  template <typename Function>
  void CorrectedMatrix::for_row(const int row, const Function &f) const
  {
    const unsigned int i = row / dim, c = row % dim, n_owned = K_.map().n_owned();
    int                E_length;
    double            *E_values;
    int               *E_columns;
    E_->ExtractMyRowView(row, E_length, E_values, E_columns);
    for (int k = 0; k < E_length; ++k)
      position_[E_column_[E_columns[k]]] = k;

    // entries of K take along what E adds to them
    bool diagonal = false;
    if (!taken_out_[row])
      K_.for_row(i,
                 [&](const unsigned int j, const double *block, const bool transposed)
                 {
                   for (unsigned int d = 0; d < dim; ++d)
                   {
                     if (taken_out_[dim * j + d])
                       continue;
                     const int column = j < n_owned ? dim * j + d : column_of_ghost_[dim * (j - n_owned) + d];
                     double    value  = block[transposed ? dim * d + c : dim * c + d];
                     if (position_[column] >= 0)
                     {
                       value += E_values[position_[column]];
                       position_[column] = -1;
                     }
                     if (value != 0. || column == row)
                       f(column, value);
                     diagonal = diagonal || column == row;
                   }
                 });
    for (int k = 0; k < E_length; ++k)
      if (const int column = E_column_[E_columns[k]]; position_[column] >= 0)
      {
        position_[column] = -1;
        f(column, E_values[k]);
        diagonal = diagonal || column == row;
      }
    if (!diagonal)
      f(row, 0.);
  }

  int CorrectedMatrix::Multiply(const bool, const Epetra_MultiVector &x, Epetra_MultiVector &y) const
  {
    const int           n     = kept_.size();
    const double *const x_all = x[0];
    double *const       y_all = y[0];
    if (takes_out_)
    {
      for (int i = 0; i < n; ++i)
        kept_[i] = taken_out_[i] ? 0. : x_all[i];
      K_.vmult(y_all, kept_.data());
      for (int i = 0; i < n; ++i)
        if (taken_out_[i])
          y_all[i] = 0.;
    }
    else
      K_.vmult(y_all, x_all);
    Epetra_MultiVector part(y.Map(), 1, false);
    const int          error = E_->Multiply(false, x, part);
    y.Update(1., part, 1.);
    return error;
  }

  int CorrectedMatrix::ExtractMyRowCopy(const int row, const int length, int &n, double *values, int *columns) const
  {
    n = length_[row];
    if (n > length)
      return -1;
    int k = 0;
    for_row(row,
            [&](const int column, const double value)
            {
              columns[k]  = column;
              values[k++] = value;
            });
    return 0;
  }

  int CorrectedMatrix::NumMyRowEntries(const int row, int &n) const
  {
    n = length_[row];
    return 0;
  }

  int CorrectedMatrix::MaxNumEntries() const
  {
    return length_.empty() ? 0 : *std::max_element(length_.begin(), length_.end());
  }

  int CorrectedMatrix::ExtractDiagonalCopy(Epetra_Vector &diagonal) const
  {
    for (int row = 0; row < diagonal.MyLength(); ++row)
      for_row(row,
              [&](const int column, const double value)
              {
                if (column == row)
                  diagonal[row] = value;
              });
    return 0;
  }
} // namespace Nodus
