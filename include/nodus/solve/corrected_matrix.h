#ifndef nodus_solve_corrected_matrix_h
#define nodus_solve_corrected_matrix_h

#include <nodus/solve/node_matrix.h>
#include <nodus/solve/saddle_point_operator.h>

#include <Epetra_BasicRowMatrix.h>

#include <memory>
#include <vector>

namespace Nodus
{
  /// A = S K S + E for multigrid: the stiffness K in its own storage, S that takes some degrees of freedom out, and a
  /// correction E with rows near the contact surfaces only.
  class CorrectedMatrix : public Epetra_BasicRowMatrix
  {
  public:
    /// @p K must outlive the matrix. @p taken_out holds a flag per degree of freedom of the local nodes of K, ghosts
    /// included; @p correction the rows owned here, sorted. Collective.
    CorrectedMatrix(const NodeMatrix &K, std::vector<char> taken_out, const std::vector<MatrixEntry> &correction);

    int  Multiply(bool transpose, const Epetra_MultiVector &x, Epetra_MultiVector &y) const override;
    int  ExtractMyRowCopy(int row, int length, int &n, double *values, int *columns) const override;
    int  NumMyRowEntries(int row, int &n) const override;
    int  ExtractDiagonalCopy(Epetra_Vector &diagonal) const override;
    int  MaxNumEntries() const override;
    bool HasNormInf() const override
    {
      return false;
    }
    /// Not available: the entries are not stored in one place.
    int ExtractMyEntryView(int, double *&, int &, int &) override
    {
      return -1;
    }
    int ExtractMyEntryView(int, double const *&, int &, int &) const override
    {
      return -1;
    }

  private:
    /// Calls f(local column, value) for the entries of a row that do not vanish, and the diagonal.
    template <typename Function>
    void for_row(int row, const Function &f) const;

    const NodeMatrix                 &K_;
    const std::vector<char>           taken_out_;
    bool                              takes_out_;
    std::vector<int>                  column_of_ghost_; ///< local columns of the ghosts of K, three each
    std::unique_ptr<Epetra_CrsMatrix> E_;
    std::vector<int>                  E_column_; ///< local columns of the columns of E
    std::vector<int>                  length_;   ///< of the rows
    mutable std::vector<double>       kept_;
    mutable std::vector<int>          position_; ///< of a column in the row at hand, -1 elsewhere
  };
} // namespace Nodus

#endif
