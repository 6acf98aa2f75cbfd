#include <nodus/solve/coupling_matrix.h>

#include <Epetra_Import.h>
#include <Epetra_Map.h>

#include <algorithm>

namespace Nodus
{
  std::unique_ptr<Epetra_CrsMatrix>
  make_matrix(const std::vector<MatrixEntry> &entries, const Epetra_Map &range, const Epetra_Map &domain)
  {
    std::vector<int>    length(std::max(1, range.NumMyElements()), 0), columns(entries.size());
    std::vector<double> values(entries.size());
    for (std::size_t k = 0; k < entries.size(); ++k)
    {
      ++length[range.LID(static_cast<int>(entries[k].row))];
      columns[k] = entries[k].column;
      values[k]  = entries[k].value;
    }
    auto        matrix = std::make_unique<Epetra_CrsMatrix>(Copy, range, length.data(), true);
    std::size_t k      = 0;
    while (k < entries.size())
    {
      const int row = entries[k].row, n = length[range.LID(row)];
      matrix->InsertGlobalValues(row, n, values.data() + k, columns.data() + k);
      k += n;
    }
    matrix->FillComplete(domain, range);
    return matrix;
  }

  void add_transposed_product(const Epetra_CrsMatrix   &A,
                              const double              factor,
                              const Epetra_MultiVector &x,
                              Epetra_MultiVector       &y)
  {
    const Epetra_Import *const import = A.Importer(); // null where columns and domain are the same
    Epetra_MultiVector         columns(A.ColMap(), 1);
    double *const              sum = import ? columns[0] : y[0];
    for (int i = 0; i < A.NumMyRows(); ++i)
    {
      int     length;
      double *values;
      int    *column;
      A.ExtractMyRowView(i, length, values, column);
      const double xi = factor * x[0][i];
      for (int k = 0; k < length; ++k)
        sum[column[k]] += values[k] * xi;
    }
    if (import)
      y.Export(columns, *import, Epetra_AddLocalAlso);
  }

  namespace
  {
    Epetra_Map rows_of(const std::vector<MatrixEntry> &entries, const Epetra_Map &range)
    {
      std::vector<int> rows;
      for (const MatrixEntry &e : entries)
        if (rows.empty() || rows.back() != static_cast<int>(e.row))
          rows.push_back(e.row);
      return Epetra_Map(-1, rows.size(), rows.data(), 0, range.Comm());
    }
  } // namespace

  CouplingMatrix::CouplingMatrix(const std::vector<MatrixEntry> &entries,
                                 const Epetra_Map               &range,
                                 const Epetra_Map               &domain)
      : rows_(make_matrix(entries, rows_of(entries, range), domain))
      , values_(rows_->RowMap(), 1)
  {
    for (int i = 0; i < rows_->NumMyRows(); ++i)
      position_.push_back(range.LID(rows_->GRID(i)));
  }

  void CouplingMatrix::add_product(const Epetra_MultiVector &x, Epetra_MultiVector &y) const
  {
    rows_->Multiply(false, x, values_);
    for (unsigned int i = 0; i < position_.size(); ++i)
      y[0][position_[i]] += values_[0][i];
  }

  void CouplingMatrix::add_transposed_product(const Epetra_MultiVector &x, Epetra_MultiVector &y) const
  {
    for (unsigned int i = 0; i < position_.size(); ++i)
      values_[0][i] = x[0][position_[i]];
    Nodus::add_transposed_product(*rows_, 1., values_, y);
  }
} // namespace Nodus
