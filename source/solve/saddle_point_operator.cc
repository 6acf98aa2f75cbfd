#include <nodus/solve/saddle_point_operator.h>
#include <nodus/wait_for_all.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <Epetra_Import.h>
#include <Epetra_Map.h>
#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Nodus
{
  Ownership::Ownership(const dealii::IndexSet &owned, const MPI_Comm communicator)
      : start_(1, 0)
      , communicator_(communicator)
  {
    if (!owned.is_ascending_and_one_to_one(communicator))
      throw SolverFailure("Krylov solver: each rank must own one range of unknowns, in the order of the ranks.");
    for (const DoFIndex n : dealii::Utilities::MPI::all_gather(communicator, owned.n_elements()))
      start_.push_back(start_.back() + n);
  }

  unsigned int Ownership::owner(const DoFIndex i) const
  {
    return std::upper_bound(start_.begin(), start_.end(), i) - start_.begin() - 1;
  }

  Ownership Ownership::times(const unsigned int factor) const
  {
    Ownership result(*this);
    for (DoFIndex &i : result.start_)
      i *= factor;
    return result;
  }

  dealii::IndexSet Ownership::owned() const
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator_);
    dealii::IndexSet   result(start_.back());
    result.add_range(start_[rank], start_[rank + 1]);
    return result;
  }

  std::vector<MatrixEntry> Ownership::exchange(std::vector<MatrixEntry> entries) const
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator_);
    const auto         first =
        std::partition(entries.begin(),
                       entries.end(),
                       [&](const MatrixEntry &e) { return e.row >= start_[rank] && e.row < start_[rank + 1]; });
    std::map<unsigned int, std::vector<MatrixEntry>> outgoing;
    for (auto e = first; e != entries.end(); ++e)
      outgoing[owner(e->row)].push_back(*e);
    entries.erase(first, entries.end());
    wait_for_all(communicator_);
    for (const auto &[source, received] : dealii::Utilities::MPI::some_to_some(communicator_, outgoing))
      entries.insert(entries.end(), received.begin(), received.end());

    const auto before = [](const MatrixEntry &a, const MatrixEntry &b)
    { return a.row != b.row ? a.row < b.row : a.column < b.column; };
    if (!std::is_sorted(entries.begin(), entries.end(), before))
      std::sort(entries.begin(), entries.end(), before);
    std::size_t n = 0;
    for (const MatrixEntry &e : entries)
      if (n > 0 && entries[n - 1].row == e.row && entries[n - 1].column == e.column)
        entries[n - 1].value += e.value;
      else
        entries[n++] = e;
    entries.resize(n);
    return entries;
  }

  SaddlePointOperator::SaddlePointOperator(const LinearSystem &system)
      : system_(system)
      , u_ownership_(system.layout->owned[0], system.layout->communicator)
      , m_ownership_(Ownership(system.layout->owned[1], system.layout->communicator).times(3))
      , owned_m_(m_ownership_.owned())
  {
    const BlockLayout       &layout = *system.layout;
    const DoFIndex           n_u    = layout.n_u;
    std::vector<MatrixEntry> uu, B, C;
    const TripletMatrix     &contact = system.contact;
    for (std::size_t k = 0; k < contact.value.size(); ++k)
    {
      const DoFIndex i = contact.row[k], j = contact.column[k];
      const double   v = contact.value[k];
      if (i < n_u && j < n_u)
        uu.push_back({i, j, v});
      else if (i >= n_u && j < n_u)
        B.push_back({to_m(i), j, v});
      else if (i >= n_u && j >= n_u)
        C.push_back({to_m(i), to_m(j), -v});
    }

    const Epetra_Map &u_map = bulk().map().row_map();
    const Epetra_Map  m_map = owned_m_.make_trilinos_map(layout.communicator, false);
    uu_entries_             = u_ownership_.exchange(std::move(uu));
    B_                      = make_matrix(m_ownership_.exchange(std::move(B)), m_map, u_map);
    C_                      = make_matrix(m_ownership_.exchange(std::move(C)), m_map, m_map);
    if (dealii::Utilities::MPI::max(uu_entries_.empty() ? 0 : 1, layout.communicator) != 0)
      C_uu_ = std::make_unique<CouplingMatrix>(uu_entries_, u_map, u_map);
    equilibrate();
    if (!system.symmetric)
      make_variation();
    const double norms = bulk().norm_squared() + B_->NormFrobenius() + C_->NormFrobenius() +
                         (C_uu_ ? C_uu_->rows().NormFrobenius() : 0.);
    if (!std::isfinite(norms))
      throw SolverFailure("Krylov solver: the matrix holds a value that is not finite.",
                          SolverFailure::Kind::not_finite);
  }

  void SaddlePointOperator::equilibrate()
  {
    const Epetra_Map         &u_map = bulk().map().row_map();
    Epetra_Vector             diagonal(u_map);
    const std::vector<double> bulk_diagonal = bulk().diagonal();
    std::copy(bulk_diagonal.begin(), bulk_diagonal.end(), diagonal.Values());
    for (const MatrixEntry &e : uu_entries_)
      if (e.row == e.column)
        diagonal[u_map.LID(static_cast<int>(e.row))] += e.value;
    double mean;
    diagonal.Norm1(&mean);
    mean /= u_map.NumGlobalElements();
    // An indefinite tangent may hold diagonal entries that are negative or nearly vanish.
    for (int i = 0; i < u_map.NumMyElements(); ++i)
      diagonal[i] = std::max(std::abs(diagonal[i]), 1e-12 * mean);

    Epetra_Vector       column_diagonal(B_->ColMap());
    const Epetra_Import import(B_->ColMap(), u_map);
    column_diagonal.Import(diagonal, import, Insert);

    const int     n = B_->NumMyRows();
    Epetra_Vector scale(B_->RowMap()), C_diagonal(B_->RowMap());
    C_->ExtractDiagonalCopy(C_diagonal);
    scale_.assign(n, 1.);
    stiffness_.assign(n, 0.);
    for (int i = 0; i < n; ++i)
    {
      int     length;
      double *values;
      int    *columns;
      B_->ExtractMyRowView(i, length, values, columns);
      double square = 0., compliance = 0.;
      for (int k = 0; k < length; ++k)
      {
        square += values[k] * values[k];
        compliance += values[k] * values[k] / column_diagonal[columns[k]];
      }
      const double c = std::abs(C_diagonal[i]);
      if (square > 0.)
      {
        stiffness_[i] = square / compliance;
        scale_[i]     = std::sqrt(square) / compliance;
        if (c > 0.) // a slip row may have next to no coupling: then C sets the scale
          scale_[i] = std::min(scale_[i], std::sqrt(stiffness_[i] / c));
      }
      else if (c > 0.)
        scale_[i] = std::sqrt(mean / c);
      scale[i] = scale_[i];
    }
    B_->LeftScale(scale);
    C_->LeftScale(scale);
    C_->RightScale(scale);
  }

  DoFIndex SaddlePointOperator::to_m(const DoFIndex flat) const
  {
    const DoFIndex i = flat - system_.layout->n_u, n_nodes = system_.layout->n_slave_nodes;
    return i < n_nodes ? 3 * i : 3 * ((i - n_nodes) / 2) + 1 + (i - n_nodes) % 2;
  }

  void SaddlePointOperator::make_variation()
  {
    const DoFIndex           n_u = system_.layout->n_u;
    std::vector<MatrixEntry> uu, um, mu, mm;
    const TripletMatrix     &v = system_.variation;
    for (std::size_t k = 0; k < v.value.size(); ++k)
    {
      const bool u_row = v.row[k] < n_u, u_column = v.column[k] < n_u;
      (u_row ? (u_column ? uu : um) : (u_column ? mu : mm))
          .push_back({u_row ? v.row[k] : to_m(v.row[k]), u_column ? v.column[k] : to_m(v.column[k]), v.value[k]});
    }
    const Epetra_Map   &u_map = bulk().map().row_map();
    const Epetra_Map    m_map = owned_m_.make_trilinos_map(system_.layout->communicator, false);
    const Epetra_Vector scale(View, m_map, scale_.data());
    variation_.uu = std::make_unique<CouplingMatrix>(u_ownership_.exchange(std::move(uu)), u_map, u_map);
    variation_.um = std::make_unique<CouplingMatrix>(u_ownership_.exchange(std::move(um)), u_map, m_map);
    variation_.mu = make_matrix(m_ownership_.exchange(std::move(mu)), m_map, u_map);
    variation_.mm = make_matrix(m_ownership_.exchange(std::move(mm)), m_map, m_map);
    variation_.um->rows().RightScale(scale);
    variation_.mu->LeftScale(scale);
    variation_.mm->LeftScale(scale);
    variation_.mm->RightScale(scale);
  }

  void SaddlePointOperator::apply_stiffness(const Epetra_MultiVector &u, Epetra_MultiVector &f) const
  {
    bulk().vmult(f[0], u[0]);
    add_coupling(u, f);
  }

  void SaddlePointOperator::add_coupling(const Epetra_MultiVector &u, Epetra_MultiVector &f) const
  {
    if (C_uu_)
      C_uu_->add_product(u, f);
  }

  Eigen::Matrix3d SaddlePointOperator::own_coupling(const DoFIndex node) const
  {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    const auto      first = std::lower_bound(uu_entries_.begin(),
                                        uu_entries_.end(),
                                        dim * node,
                                        [](const MatrixEntry &e, const DoFIndex row) { return e.row < row; });
    for (auto e = first; e != uu_entries_.end() && e->row < dim * node + dim; ++e)
      if (e->column / dim == node)
        block(e->row % dim, e->column % dim) += e->value;
    return block;
  }

  void SaddlePointOperator::vmult(BlockVector &dst, const BlockVector &src) const
  {
    const Epetra_MultiVector &u = src.block(0).trilinos_vector(), &m = src.block(1).trilinos_vector();
    Epetra_MultiVector       &f = dst.block(0).trilinos_vector(), &g = dst.block(1).trilinos_vector();

    apply_stiffness(u, f);
    add_transposed_product(*B_, 1., m, f);

    Epetra_MultiVector m_part(g.Map(), 1, false);
    B_->Multiply(false, u, g);
    C_->Multiply(false, m, m_part);
    g.Update(-1., m_part, 1.);
    if (!variation_.uu)
      return;
    variation_.uu->add_product(u, f);
    variation_.um->add_product(m, f);
    variation_.mu->Multiply(false, u, m_part);
    g.Update(1., m_part, 1.);
    variation_.mm->Multiply(false, m, m_part);
    g.Update(1., m_part, 1.);
  }

  BlockVector SaddlePointOperator::scaled(const BlockVector &rhs) const
  {
    BlockVector b(std::vector<dealii::IndexSet>{system_.layout->owned[0], owned_m_}, system_.layout->communicator);
    b.block(0)                           = rhs.block(0);
    Epetra_MultiVector       &m          = b.block(1).trilinos_vector();
    const Epetra_MultiVector &normal     = rhs.block(1).trilinos_vector();
    const Epetra_MultiVector &tangential = rhs.block(2).trilinos_vector();
    for (int k = 0; k < normal.MyLength(); ++k)
    {
      m[0][3 * k]     = scale_[3 * k] * normal[0][k];
      m[0][3 * k + 1] = scale_[3 * k + 1] * tangential[0][2 * k];
      m[0][3 * k + 2] = scale_[3 * k + 2] * tangential[0][2 * k + 1];
    }
    return b;
  }

  void SaddlePointOperator::to_solution(const BlockVector &x, BlockVector &solution) const
  {
    system_.layout->reinit(solution);
    solution.block(0)                    = x.block(0);
    const Epetra_MultiVector &m          = x.block(1).trilinos_vector();
    Epetra_MultiVector       &normal     = solution.block(1).trilinos_vector();
    Epetra_MultiVector       &tangential = solution.block(2).trilinos_vector();
    for (int k = 0; k < normal.MyLength(); ++k)
    {
      normal[0][k]             = scale_[3 * k] * m[0][3 * k];
      tangential[0][2 * k]     = scale_[3 * k + 1] * m[0][3 * k + 1];
      tangential[0][2 * k + 1] = scale_[3 * k + 2] * m[0][3 * k + 2];
    }
  }

  LinearSolver::Report
  SaddlePointOperator::solve_each(const std::vector<const BlockVector *>                                       &rhs,
                                  const std::string                                                            &solver,
                                  const std::function<unsigned int(const BlockVector &scaled, BlockVector &x)> &iterate,
                                  std::vector<BlockVector> &solutions) const
  {
    LinearSolver::Report report;
    solutions.resize(rhs.size());
    for (unsigned int n = 0; n < rhs.size(); ++n)
    {
      const BlockVector b = scaled(*rhs[n]);
      BlockVector       x;
      x.reinit(b);
      const double norm_b = b.l2_norm();
      if (!std::isfinite(norm_b))
        throw SolverFailure(solver + ": the right-hand side holds a value that is not finite.",
                            SolverFailure::Kind::not_finite);
      if (norm_b > 0.)
      {
        report.iterations += iterate(b, x);
        BlockVector r;
        r.reinit(b);
        vmult(r, x);
        r.sadd(-1., 1., b);
        if (n == 0)
          report.relative_residual = unscaled_norm(r) / unscaled_norm(b);
      }
      to_solution(x, solutions[n]);
    }
    return report;
  }

  double SaddlePointOperator::unscaled_norm(const BlockVector &residual) const
  {
    const Epetra_MultiVector &m   = residual.block(1).trilinos_vector();
    double                    sum = 0.;
    for (int i = 0; i < m.MyLength(); ++i)
      sum += (m[0][i] / scale_[i]) * (m[0][i] / scale_[i]);
    return std::sqrt(dealii::Utilities::MPI::sum(sum, system_.layout->communicator) + residual.block(0).norm_sqr());
  }
} // namespace Nodus
