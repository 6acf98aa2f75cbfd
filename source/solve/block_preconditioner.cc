#include <nodus/solve/block_preconditioner.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  }

  BlockPreconditioner::BlockPreconditioner(const SaddlePointOperator &system,
                                           const double               augmentation_factor,
                                           const std::vector<Point>  &node_positions)
      : system_(system)
      , multiplier_part_(3 * system.slave_nodes().size())
  {
    augmented_rhs_.reinit(system.displacement_ownership().owned(), system.bulk().map().communicator());
    make_multiplier_blocks(augmentation_factor);
    make_augmented_matrix();
    // three sweeps pay off against the stiff couplings of the augmentation
    multigrid_ =
        std::make_unique<Multigrid>(system.bulk(), *augmented_, rigid_body_modes(system.bulk(), node_positions), 3);
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
      // A slipping node that Newton moves back inside its threshold has a negative C, of which D must stay clear.
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(C_node);
      const Eigen::Matrix3d D = regularisation + eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.).asDiagonal() *
                                                     eigen.eigenvectors().transpose();
      Eigen::Map<Block>(D_inverse_[node].data()) = D.inverse();
    }
  }

  void BlockPreconditioner::make_augmented_matrix()
  {
    const CouplingMatrix &B         = system_.B();
    const unsigned int    n_columns = B.columns().size();

    // For every displacement (local column of B), the slave nodes whose rows hold it.
    std::vector<std::vector<unsigned int>> nodes_of_column(n_columns);
    // Per node, its columns and the three coefficients of each.
    std::vector<std::vector<unsigned int>> columns_of_node(D_inverse_.size());
    std::vector<Eigen::Matrix3Xd>          rows_of_node(D_inverse_.size());
    std::vector<int>                       position(n_columns, -1);
    for (unsigned int node = 0; node < D_inverse_.size(); ++node)
    {
      std::vector<unsigned int> &node_columns = columns_of_node[node];
      for (unsigned int a = 0; a < 3; ++a)
        B.for_row(3 * node + a,
                  [&](const unsigned int column, const double)
                  {
                    if (position[column] >= 0)
                      return;
                    position[column] = node_columns.size();
                    node_columns.push_back(column);
                    nodes_of_column[column].push_back(node);
                  });
      rows_of_node[node] = Eigen::Matrix3Xd::Zero(3, node_columns.size());
      for (unsigned int a = 0; a < 3; ++a)
        B.for_row(3 * node + a,
                  [&](const unsigned int column, const double value)
                  { rows_of_node[node](a, position[column]) = value; });
      for (const unsigned int c : node_columns)
        position[c] = -1;
    }

    // B^T D^-1 B, row by row, so that the contributions of several nodes are added before they travel.
    std::vector<MatrixEntry>  entries = system_.displacement_entries();
    std::vector<double>       sum(n_columns, 0.);
    std::vector<unsigned int> touched;
    for (unsigned int row = 0; row < n_columns; ++row)
    {
      for (const unsigned int node : nodes_of_column[row])
      {
        const std::vector<unsigned int> &columns = columns_of_node[node];
        const Eigen::Matrix3Xd          &rows    = rows_of_node[node];
        const auto                       here    = std::find(columns.begin(), columns.end(), row) - columns.begin();
        const Eigen::Vector3d            factor  = Eigen::Map<const Block>(D_inverse_[node].data()) * rows.col(here);
        for (unsigned int k = 0; k < columns.size(); ++k)
        {
          if (position[columns[k]] < 0)
          {
            position[columns[k]] = 0;
            touched.push_back(columns[k]);
          }
          sum[columns[k]] += factor.dot(rows.col(k));
        }
      }
      for (const unsigned int c : touched)
      {
        entries.push_back({B.columns()[row], B.columns()[c], sum[c]});
        sum[c]      = 0.;
        position[c] = -1;
      }
      touched.clear();
    }
    entries = system_.displacement_ownership().exchange(std::move(entries));

    augmented_ =
        std::make_unique<CorrectedMatrix>(system_.bulk(), std::vector<char>(system_.bulk().map().size(), 0), entries);
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
    const double *const g = src.block(1).trilinos_vector()[0];
    std::copy_n(g, multiplier_part_.size(), multiplier_part_.begin());
    apply_multiplier_blocks(multiplier_part_.data());
    augmented_rhs_ = src.block(0);
    system_.B().add_transposed_product(multiplier_part_.data(), augmented_rhs_.trilinos_vector()[0]);

    multigrid_->vmult(dst.block(0), augmented_rhs_);

    double *const m = dst.block(1).trilinos_vector()[0];
    for (std::size_t i = 0; i < multiplier_part_.size(); ++i)
      m[i] = -g[i];
    system_.B().add_product(dst.block(0).trilinos_vector()[0], m);
    apply_multiplier_blocks(m);
  }
} // namespace Nodus
