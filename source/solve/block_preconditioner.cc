#include "solve/block_preconditioner.h"
#include "solve/multigrid/multigrid.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>

namespace Nodus
{
  namespace
  {
    using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  }

  BlockPreconditioner::BlockPreconditioner(const SaddlePointOperator  &system,
                                           const double                augmentation_factor,
                                           const DisplacementNodes    &nodes,
                                           DisplacementPreconditioner &multigrid)
      : system_(system)
      , multigrid_(multigrid)
      , multiplier_part_(3 * system.slave_nodes().size())
  {
    augmented_rhs_.reinit(system.displacement_ownership().owned(), system.bulk().map().communicator());
    make_multiplier_blocks(augmentation_factor);
    multigrid_.set_up(system.bulk(), augmentation(), rigid_body_modes(system.bulk(), nodes.positions), nodes);
  }

  void BlockPreconditioner::make_multiplier_blocks(const double augmentation_factor)
  {
    const CouplingMatrix &C                = system_.C();
    const DoFIndex        first_multiplier = system_.multiplier_ownership().begin();
    D_inverse_.resize(system_.slave_nodes().size());
    for (unsigned int node = 0; node < D_inverse_.size(); ++node)
    {
      Block C_node = Block::Zero(), regularisation = Block::Zero();
      for (unsigned int a = 0; a < 3; ++a)
      {
        const int row = 3 * node + a;
        C.for_row(row,
                  [&](const unsigned int column, const double value)
                  {
                    const DoFIndex multiplier = C.columns()[column];
                    if (multiplier / 3 == first_multiplier / 3 + node)
                      C_node(a, multiplier % 3) += value;
                  });
        regularisation(a, a) = system_.stiffness()[row] / augmentation_factor;
        if (regularisation(a, a) == 0. && C_node.row(a).isZero(0.)) // a void multiplier
          regularisation(a, a) = 1.;
      }
      // C >= 0 but for round-off, which D stays clear of: slip inside of the unit ball has the rows of stick (eq. 48).
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(C_node);
      const Eigen::Matrix3d D = regularisation + eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.).asDiagonal() *
                                                     eigen.eigenvectors().transpose();
      Eigen::Map<Block>(D_inverse_[node].data()) = D.inverse();
    }
  }

  /// B^T D^-1 B, and friction.
  Constraints BlockPreconditioner::augmentation() const
  {
    const CouplingMatrix &B = system_.B();
    Constraints           constraints;
    for (unsigned int k = 0; k < D_inverse_.size(); ++k)
    {
      std::map<DoFIndex, Block> blocks;
      for (unsigned int a = 0; a < 3; ++a)
        B.for_row(3 * k + a,
                  [&](const unsigned int column, const double value)
                  {
                    const DoFIndex dof = B.columns()[column];
                    blocks.try_emplace(dof / dim, Block::Zero()).first->second(a, dof % dim) += value;
                  });
      if (blocks.empty())
        continue;
      // friction couples displacements along the rows of B, at nodes of several sites along unknown ones
      Block          D        = Eigen::Map<const Block>(D_inverse_[k].data());
      const DoFIndex node     = system_.slave_nodes()[k];
      const Block    friction = system_.own_coupling(node);
      if (const auto own = blocks.find(node); own != blocks.end() && !friction.isZero(0.) && !system_.shares_node(k))
      {
        const Eigen::Matrix3d inverse = Eigen::Matrix3d(own->second).completeOrthogonalDecomposition().pseudoInverse();
        D += inverse.transpose() * friction * inverse;
      }
      Constraints::Spring spring;
      Eigen::Map<Block>(spring.D.data()) = D;
      for (const auto &[other, block] : blocks)
        Eigen::Map<Block>(spring.row.emplace_back(other, std::array<double, 9>()).second.data()) = block;
      constraints.springs.push_back(std::move(spring));
    }
    return constraints;
  }

  void BlockPreconditioner::apply_multiplier_blocks(double *const m) const
  {
    for (std::size_t node = 0; node < D_inverse_.size(); ++node)
    {
      Eigen::Map<Eigen::Vector3d> values(m + 3 * node);
      values = (Eigen::Map<const Block>(D_inverse_[node].data()) * values).eval();
    }
  }

  void BlockPreconditioner::vmult(BlockVector &dst, const BlockVector &src) const
  {
    const double *const g = src.block(1).begin();
    std::copy_n(g, multiplier_part_.size(), multiplier_part_.begin());
    apply_multiplier_blocks(multiplier_part_.data());
    augmented_rhs_ = src.block(0);
    system_.B().add_transposed_product(multiplier_part_.data(), augmented_rhs_.begin());

    multigrid_.vmult(dst.block(0), augmented_rhs_);

    double *const m = dst.block(1).begin();
    for (std::size_t i = 0; i < multiplier_part_.size(); ++i)
      m[i] = -g[i];
    system_.B().add_product(dst.block(0).begin(), m);
    apply_multiplier_blocks(m);
  }
} // namespace Nodus
