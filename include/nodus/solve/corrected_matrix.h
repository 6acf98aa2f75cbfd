#ifndef nodus_solve_corrected_matrix_h
#define nodus_solve_corrected_matrix_h

#include <nodus/solve/node_matrix.h>
#include <nodus/solve/saddle_point_operator.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace Nodus
{
  /// A = S K S + E for multigrid: the stiffness K, S that takes some nodes out, and a symmetric correction E of 3x3
  /// blocks with rows near the contact surfaces only. Products use a copy of S K S in single precision, and so is E:
  /// half the memory traffic.
  class CorrectedMatrix
  {
  public:
    /// @p taken_out holds a flag per local node of K, ghosts included; @p correction the
    /// rows owned here, sorted. Collective.
    CorrectedMatrix(const NodeMatrix &K, std::vector<char> taken_out, const std::vector<MatrixEntry> &correction);

    /// Local numbers of the nodes: those of K, then ghosts of the correction.
    const NodeMap &map() const
    {
      return nodes_;
    }
    /// y = A x over the owned degrees of freedom. Collective.
    void vmult(double *y, const double *x) const;

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
    const std::vector<char>                  taken_out_;
    const NodeMap                            nodes_;
    const std::shared_ptr<const NodePattern> pattern_;
    std::vector<float>                       stiffness_; ///< S K S
    std::vector<unsigned int>                rows_;      ///< of the correction that are not empty
    std::vector<std::uint32_t>               start_, column_;
    std::vector<float>                       values_; ///< and 3 more
  };
} // namespace Nodus

#endif
