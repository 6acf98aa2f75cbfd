#ifndef nodus_solve_coupling_matrix_h
#define nodus_solve_coupling_matrix_h

#include <nodus/types.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_MultiVector.h>

#include <memory>
#include <vector>

namespace Nodus
{
  /// An entry of a distributed matrix, on its way to the rank that owns the row.
  struct MatrixEntry
  {
    DoFIndex row, column;
    double   value;

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &row &column &value;
    }
  };

  /// Matrix of the sorted @p entries of owned rows, with the given row and column maps. Collective.
  std::unique_ptr<Epetra_CrsMatrix>
  make_matrix(const std::vector<MatrixEntry> &entries, const Epetra_Map &range, const Epetra_Map &domain);

  /// y += factor A^T x. Touches only the columns that A has entries in. Collective.
  void
  add_transposed_product(const Epetra_CrsMatrix &A, double factor, const Epetra_MultiVector &x, Epetra_MultiVector &y);

  /// Matrix with entries in few rows, as contact couples the displacements of few nodes: products pass over those rows
  /// alone, and the others take no memory.
  class CouplingMatrix
  {
  public:
    /// As make_matrix().
    CouplingMatrix(const std::vector<MatrixEntry> &entries, const Epetra_Map &range, const Epetra_Map &domain);

    /// y += A x, over the whole range. Collective.
    void add_product(const Epetra_MultiVector &x, Epetra_MultiVector &y) const;
    /// y += A^T x, @p x over the whole range. Collective.
    void add_transposed_product(const Epetra_MultiVector &x, Epetra_MultiVector &y) const;

    /// The rows with entries.
    Epetra_CrsMatrix &rows()
    {
      return *rows_;
    }

  private:
    std::vector<int>                  position_; ///< of the rows, in vectors over the range
    std::unique_ptr<Epetra_CrsMatrix> rows_;
    mutable Epetra_MultiVector        values_; ///< of the rows
  };
} // namespace Nodus

#endif
