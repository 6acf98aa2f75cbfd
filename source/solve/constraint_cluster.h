#ifndef nodus_solve_constraint_cluster_h
#define nodus_solve_constraint_cluster_h

#include <nodus/base/types.h>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Constraints of slave nodes that see each other's displacements, all of them known to every rank: with their
  /// displacements y_c along the constraints, M y_c + R y = g, R in terms of the other unknowns.
  struct ConstraintCluster
  {
    std::map<DoFIndex, unsigned int>                                  first;  ///< row of a node's first constraint
    std::vector<std::vector<std::pair<DoFIndex, Eigen::RowVector3d>>> others; ///< R, row by row
    Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> M, M_transposed;
    unsigned int                                                             size    = 0;
    unsigned int                                                             n_ranks = 0; ///< that own such nodes
  };

  /// Blocks as numbers, on their way to other ranks.
  inline void append(std::vector<double> &numbers, const Eigen::Matrix3d &block)
  {
    numbers.insert(numbers.end(), block.data(), block.data() + 9);
  }
  inline std::array<double, 9> by_rows(const Eigen::Matrix3d &block)
  {
    std::array<double, 9> result;
    Eigen::Map<Eigen::Matrix<double, dim, dim, Eigen::RowMajor>>(result.data()) = block;
    return result;
  }
  inline Eigen::Matrix3d read(const double *&numbers)
  {
    const Eigen::Matrix3d block = Eigen::Map<const Eigen::Matrix3d>(numbers);
    numbers += 9;
    return block;
  }
} // namespace Nodus

#endif
