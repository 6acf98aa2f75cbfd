#ifndef nodus_solve_aggregation_h
#define nodus_solve_aggregation_h

#include <nodus/solve/corrected_matrix.h>

#include <Eigen/Core>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_MultiVector.h>

#include <array>
#include <memory>
#include <vector>

namespace Nodus
{
  /// The first coarse level of smoothed aggregation (Vanek, Mandel, Brezina 1996) in node blocks: six unknowns for each
  /// aggregate of nodes, which combine the six modes there.
  ///
  ///     P = (1 - omega D^-1 A) P_0,   A_coarse = P^T A P
  ///
  /// P_0 holds the modes of each aggregate, orthonormal. Blocks need a ninth of the indices of a general sparse matrix,
  /// and their products fill vector registers.
  class Aggregation
  {
  public:
    /// @param modes of the owned displacements, six one after the other @param D_inverse of the owned nodes, row by row
    /// Collective.
    Aggregation(const NodeMatrix                         &K,
                const CorrectedMatrix                    &A,
                const std::vector<double>                &modes,
                const std::vector<std::array<double, 9>> &D_inverse,
                double                                    omega);

    const Epetra_CrsMatrix &matrix() const
    {
      return *matrix_;
    }
    /// The modes in the unknowns of the coarse level, six one after the other.
    const std::vector<double> &modes() const
    {
      return coarse_modes_;
    }
    /// coarse = P^T fine. Collective.
    void restrict_to(Epetra_MultiVector &coarse, const double *fine) const;
    /// fine += P coarse. Collective.
    void add_prolongation(double *fine, const Epetra_MultiVector &coarse) const;

    static constexpr unsigned int n_modes = 6;

  private:
    static constexpr unsigned int block_size = dim * n_modes;
    /// Global aggregate and block of P, with two values more for reading it in vectors.
    using Row = std::vector<std::pair<DoFIndex, std::array<float, block_size + 2>>>;

    void aggregate(const NodeMatrix &K, const std::vector<double> &modes);
    void make_tentative(const std::vector<double> &modes);
    void smooth(const NodeMatrix                         &K,
                const CorrectedMatrix                    &A,
                const std::vector<std::array<double, 9>> &D_inverse,
                double                                    omega);
    void make_coarse_matrix(const NodeMatrix &K, const CorrectedMatrix &A);

    std::vector<Row> ghost_rows() const;
    DoFIndex         global_aggregate(const unsigned int a) const
    {
      return a < n_aggregates_ ? first_ + a : ghosts_[a - n_aggregates_];
    }

    const NodeMap            &nodes_;
    unsigned int              n_aggregates_ = 0; ///< owned
    DoFIndex                  first_        = 0; ///< global number of the first one
    std::vector<DoFIndex>     ghosts_;           ///< aggregates of other ranks, ascending
    std::vector<unsigned int> aggregate_;        ///< of the local nodes, or invalid
    std::vector<double>       tentative_;        ///< like modes
    std::vector<double>       coarse_modes_;
    // P: per entry a local aggregate and three displacements by six modes, row by row. Single precision halves what a
    // cycle reads; P^T A P belongs to the rounded P.
    std::vector<std::uint32_t>                  start_, column_;
    std::vector<float>                          blocks_;
    std::unique_ptr<Epetra_Map>                 row_map_, column_map_;
    std::unique_ptr<Epetra_Import>              import_; ///< null when no rank has ghosts
    std::unique_ptr<Epetra_CrsMatrix>           matrix_;
    mutable std::unique_ptr<Epetra_MultiVector> values_;
  };
} // namespace Nodus

#endif
