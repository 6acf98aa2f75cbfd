#include <nodus/solve/block_preconditioner.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Dense>
#include <Epetra_Map.h>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Nodus
{
  namespace
  {
    using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  }

  BlockPreconditioner::BlockPreconditioner(const SaddlePointOperator &system,
                                           const double               augmentation_factor,
                                           const RigidBodyData       &rigid_body_data)
      : system_(system)
      , multiplier_part_(std::make_unique<Epetra_MultiVector>(system.B().RowMap(), 1))
  {
    augmented_rhs_.reinit(system.displacement_ownership().owned(),
                          dynamic_cast<const Epetra_MpiComm &>(system.bulk().Comm()).Comm());
    make_multiplier_blocks(augmentation_factor);
    make_augmented_matrix();
    make_rigid_body_modes(rigid_body_data);
    make_multigrid();
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
    const Epetra_CrsMatrix &B = system_.B(), &bulk = system_.bulk();

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

    // bulk plus entries, with merged pattern
    std::vector<int> extra_length(std::max(1, bulk.NumMyRows()), 0), length(extra_length.size());
    for (const MatrixEntry &e : entries)
      ++extra_length[bulk.LRID(static_cast<int>(e.row))];
    for (int r = 0; r < bulk.NumMyRows(); ++r)
      length[r] = bulk.NumMyEntries(r) + extra_length[r];
    augmented_ = std::make_unique<Epetra_CrsMatrix>(Copy, bulk.RowMap(), length.data(), false);

    std::vector<int>    merged_columns;
    std::vector<double> merged_values;
    auto                next = entries.begin();
    for (int r = 0; r < bulk.NumMyRows(); ++r)
    {
      int     n;
      double *values;
      int    *columns;
      bulk.ExtractMyRowView(r, n, values, columns);
      merged_columns.resize(n);
      merged_values.assign(values, values + n);
      for (int k = 0; k < n; ++k)
        merged_columns[k] = bulk.GCID(columns[k]);
      for (int k = 0; k < extra_length[r]; ++k, ++next)
      {
        merged_columns.push_back(next->column);
        merged_values.push_back(next->value);
      }
      // Epetra merges columns that occur twice when it completes the matrix.
      augmented_->InsertGlobalValues(bulk.GRID(r), merged_values.size(), merged_values.data(), merged_columns.data());
    }
    augmented_->FillComplete(bulk.DomainMap(), bulk.RangeMap());
    augmented_->OptimizeStorage();
  }

  void BlockPreconditioner::make_rigid_body_modes(const RigidBodyData &data)
  {
    const Epetra_CrsMatrix &bulk = system_.bulk();
    const MPI_Comm          comm = dynamic_cast<const Epetra_MpiComm &>(bulk.Comm()).Comm();
    const std::size_t       n    = bulk.NumMyRows();
    if (dealii::Utilities::MPI::max(data.support_points.size() == n && data.component.size() == n ? 0 : 1, comm) != 0)
      throw SolverFailure("Block solver: the rigid-body data does not match the displacements of the system.");

    Vector3 centre, extent;
    for (unsigned int d = 0; d < dim; ++d)
    {
      double lower = std::numeric_limits<double>::max(), upper = std::numeric_limits<double>::lowest();
      for (const Point &p : data.support_points)
      {
        lower = std::min(lower, p[d]);
        upper = std::max(upper, p[d]);
      }
      lower     = dealii::Utilities::MPI::min(lower, comm);
      upper     = dealii::Utilities::MPI::max(upper, comm);
      centre[d] = .5 * (lower + upper);
      extent[d] = upper - lower;
    }
    const double length = extent.norm();

    modes_.assign(6 * std::max<std::size_t>(n, 1), 0.);
    for (std::size_t i = 0; i < n; ++i)
    {
      int     row_length;
      double *values;
      int    *columns;
      bulk.ExtractMyRowView(i, row_length, values, columns);
      bool constrained = true; // only a diagonal
      for (int k = 0; k < row_length && constrained; ++k)
        constrained = values[k] == 0. || bulk.GCID(columns[k]) == bulk.GRID(i);
      if (constrained)
        continue;
      const Vector3      x = (data.support_points[i] - Point(centre)) / length;
      const unsigned int c = data.component[i];
      modes_[c * n + i]    = 1.;
      // rotation about axis a: e_a x x
      modes_[(3 + (c + 1) % 3) * n + i] = x[(c + 2) % 3];
      modes_[(3 + (c + 2) % 3) * n + i] = -x[(c + 1) % 3];
    }
  }

  void BlockPreconditioner::make_multigrid()
  {
    using AMG = dealii::TrilinosWrappers::PreconditionAMG;
    AMG::AdditionalData data;
    data.elliptic              = true;
    data.smoother_sweeps       = 3; // pays off against the stiff couplings of the augmentation
    data.aggregation_threshold = 0.;
    Teuchos::ParameterList              parameters;
    std::unique_ptr<Epetra_MultiVector> unused;
    data.set_parameters(parameters, unused, *augmented_);
    parameters.set("PDE equations", 3);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", 6);
    parameters.set("null space: vectors", modes_.data());
    parameters.set("null space: add default vectors", false);
    multigrid_.initialize(*augmented_, parameters);
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
    system_.B().Multiply(true, m, f);
    f.Update(1., src.block(0).trilinos_vector(), 1.);

    multigrid_.vmult(dst.block(0), augmented_rhs_);

    Epetra_MultiVector &result = dst.block(1).trilinos_vector();
    system_.B().Multiply(false, dst.block(0).trilinos_vector(), result);
    result.Update(-1., src.block(1).trilinos_vector(), 1.);
    apply_multiplier_blocks(result);
  }
} // namespace Nodus
