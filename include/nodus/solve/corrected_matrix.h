#ifndef nodus_solve_corrected_matrix_h
#define nodus_solve_corrected_matrix_h

#include <nodus/solve/node_matrix.h>
#include <nodus/solve/transformation.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace Nodus
{
  /// S K S + E in factors, T^T K T + R^T D R + d: T and R couple a slave node with some ten others, E each of these with
  /// a hundred.
  struct CorrectionFactors
  {
    std::shared_ptr<const Transformation>        T;
    std::unique_ptr<const CouplingMatrix>        R; ///< three rows for each block of D
    std::vector<std::array<double, 9>>           D; ///< symmetric
    std::vector<std::pair<unsigned int, double>> d; ///< owned displacements without meaning, and their d
  };

  /// A = S K S + E for multigrid: the stiffness K, S that takes some nodes out, and a symmetric correction E of 3x3
  /// blocks with rows near the contact surfaces only. Products use a copy of S K S in single precision, and so is E:
  /// half the memory traffic.
  class CorrectedMatrix
  {
  public:
    /// @p taken_out holds a flag per local node of K, ghosts included; @p correction the
    /// rows owned here, sorted @param factors of the same, for products; without them those take E. Collective.
    CorrectedMatrix(const NodeMatrix               &K,
                    std::vector<char>               taken_out,
                    const std::vector<MatrixEntry> &correction,
                    CorrectionFactors               factors = CorrectionFactors());

    /// Local numbers of the nodes: those of K, then ghosts of the correction.
    const NodeMap &map() const
    {
      return nodes_;
    }
    /// y = A x over the owned degrees of freedom; meanwhile @p x is T x. Collective.
    void vmult(double *y, double *x) const;

    /// Calls f(column node, 3x3 block row by row, transposed) for the blocks of an owned row; those of one column add
    /// up.
    /// @p K is the one of the constructor.
    template <typename Function>
    void for_row(const NodeMatrix &K, const unsigned int i, const Function &f) const
    {
      if (!taken_out_[i])
        K.for_row(i,
                  [&](const unsigned int j, const double *block, const bool transposed)
                  {
                    if (!taken_out_[j])
                      f(j, block, transposed);
                  });
      for (std::size_t k = start_[i]; k < start_[i + 1]; ++k)
      {
        double block[9];
        std::copy_n(values_.begin() + 9 * k, 9, block);
        f(column_[k], static_cast<const double *>(block), false);
      }
    }

  private:
    void vmult_by_factors(double *y, double *x) const;

    const std::vector<char>                  taken_out_;
    const NodeMap                            nodes_;
    const std::shared_ptr<const NodePattern> pattern_;
    const CorrectionFactors                  factors_;
    std::vector<float>                       stiffness_; ///< S K S, with factors K
    std::vector<unsigned int>                rows_;      ///< of the correction that are not empty
    std::vector<std::uint32_t>               start_, column_;
    std::vector<float>                       values_; ///< and 3 more
    mutable std::vector<double>              springs_; ///< R x
  };
} // namespace Nodus

#endif
