#include <nodus/solve/block_preconditioner.h>

#include <Eigen/Dense>
#include <Epetra_Map.h>

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
      , multiplier_part_(std::make_unique<Epetra_MultiVector>(system.B().RowMap(), 1))
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
    const Epetra_CrsMatrix &C = system_.C();
    D_inverse_.resize(C.NumMyRows() / 3);
    for (unsigned int node = 0; node < D_inverse_.size(); ++node)
    {
      Block C_node = Block::Zero(), regularisation = Block::Zero();
      for (unsigned int a = 0; a < 3; ++a)
      {
        const int row = 3 * node + a;
        int       length;
        double   *values;
        int      *columns;
        C.ExtractMyRowView(row, length, values, columns);
        for (int k = 0; k < length; ++k)
          if (const int b = C.GCID(columns[k]) - C.GRID(3 * node); b >= 0 && b < 3)
            C_node(a, b) += values[k];
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
    const Epetra_CrsMatrix &B = system_.B();

    // For every displacement (local column of B), the slave nodes whose rows hold it.
    std::vector<std::vector<int>> nodes_of_column(B.NumMyCols());
    // Per node, its columns and the three coefficients of each.
    std::vector<std::vector<int>> columns_of_node(D_inverse_.size());
    std::vector<Eigen::Matrix3Xd> rows_of_node(D_inverse_.size());
    std::vector<int>              position(B.NumMyCols(), -1);
    for (unsigned int node = 0; node < D_inverse_.size(); ++node)
    {
      std::vector<int> &node_columns = columns_of_node[node];
      int               length;
      double           *values;
      int              *columns;
      for (unsigned int a = 0; a < 3; ++a)
      {
        B.ExtractMyRowView(3 * node + a, length, values, columns);
        for (int k = 0; k < length; ++k)
          if (position[columns[k]] < 0)
          {
            position[columns[k]] = node_columns.size();
            node_columns.push_back(columns[k]);
            nodes_of_column[columns[k]].push_back(node);
          }
      }
      rows_of_node[node] = Eigen::Matrix3Xd::Zero(3, node_columns.size());
      for (unsigned int a = 0; a < 3; ++a)
      {
        B.ExtractMyRowView(3 * node + a, length, values, columns);
        for (int k = 0; k < length; ++k)
          rows_of_node[node](a, position[columns[k]]) = values[k];
      }
      for (const int c : node_columns)
        position[c] = -1;
    }

    // B^T D^-1 B, row by row, so that the contributions of several nodes are added before they travel.
    std::vector<MatrixEntry> entries = system_.displacement_entries();
    std::vector<double>      sum(B.NumMyCols(), 0.);
    std::vector<int>         touched;
    for (int row = 0; row < B.NumMyCols(); ++row)
    {
      for (const int node : nodes_of_column[row])
      {
        const std::vector<int> &columns = columns_of_node[node];
        const Eigen::Matrix3Xd &rows    = rows_of_node[node];
        const auto              here    = std::find(columns.begin(), columns.end(), row) - columns.begin();
        const Eigen::Vector3d   factor  = Eigen::Map<const Block>(D_inverse_[node].data()) * rows.col(here);
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
      for (const int c : touched)
      {
        entries.push_back({static_cast<DoFIndex>(B.GCID(row)), static_cast<DoFIndex>(B.GCID(c)), sum[c]});
        sum[c]      = 0.;
        position[c] = -1;
      }
      touched.clear();
    }
    entries = system_.displacement_ownership().exchange(std::move(entries));

    augmented_ =
        std::make_unique<CorrectedMatrix>(system_.bulk(), std::vector<char>(system_.bulk().map().size(), 0), entries);
  }

  void BlockPreconditioner::apply_multiplier_blocks(Epetra_MultiVector &m) const
  {
    for (std::size_t node = 0; node < D_inverse_.size(); ++node)
    {
      Eigen::Map<Eigen::Vector3d> values(m[0] + 3 * node);
      values = (Eigen::Map<const Block>(D_inverse_[node].data()) * values).eval();
    }
  }

  void BlockPreconditioner::vmult(BlockVector &dst, const BlockVector &src) const
  {
    Epetra_MultiVector &m = *multiplier_part_;
    m                     = src.block(1).trilinos_vector();
    apply_multiplier_blocks(m);
    Epetra_MultiVector &f = augmented_rhs_.trilinos_vector();
    f                     = src.block(0).trilinos_vector();
    add_transposed_product(system_.B(), 1., m, f);

    multigrid_->vmult(dst.block(0), augmented_rhs_);

    Epetra_MultiVector &result = dst.block(1).trilinos_vector();
    system_.B().Multiply(false, dst.block(0).trilinos_vector(), result);
    result.Update(-1., src.block(1).trilinos_vector(), 1.);
    apply_multiplier_blocks(result);
  }
} // namespace Nodus
