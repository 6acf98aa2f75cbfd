#include "solve/saddle_point_operator.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
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

    uu_entries_ = u_ownership_.exchange(std::move(uu));
    B_          = std::make_unique<CouplingMatrix>(m_ownership_.exchange(std::move(B)), m_ownership_, u_ownership_);
    C_          = std::make_unique<CouplingMatrix>(m_ownership_.exchange(std::move(C)), m_ownership_, m_ownership_);
    if (dealii::Utilities::MPI::max(uu_entries_.empty() ? 0 : 1, layout.communicator) != 0)
      C_uu_ = std::make_unique<CouplingMatrix>(uu_entries_, u_ownership_, u_ownership_);
    equilibrate();
    if (!system.symmetric)
      make_variation();
    const double norms =
        bulk().norm_squared() + B_->norm_squared() + C_->norm_squared() + (C_uu_ ? C_uu_->norm_squared() : 0.);
    if (!std::isfinite(norms))
      throw SolverFailure("Krylov solver: the matrix holds a value that is not finite",
                          SolverFailure::Kind::not_finite);
  }

  void SaddlePointOperator::equilibrate()
  {
    std::vector<double> diagonal = bulk().diagonal();
    for (const MatrixEntry &e : uu_entries_)
      if (e.row == e.column)
        diagonal[e.row - u_ownership_.begin()] += e.value;
    double mean = 0.;
    for (const double entry : diagonal)
      mean += std::abs(entry);
    mean = dealii::Utilities::MPI::sum(mean, communicator()) / system_.layout->n_u;
    // An indefinite tangent may hold diagonal entries that are negative or nearly vanish.
    for (double &entry : diagonal)
      entry = std::max(std::abs(entry), 1e-12 * mean);

    const double *const column_diagonal = B_->at_columns(diagonal.data());
    const unsigned int  n               = m_ownership_.end() - m_ownership_.begin();
    scale_.assign(n, 1.);
    stiffness_.assign(n, 0.);
    for (unsigned int i = 0; i < n; ++i)
    {
      double square = 0., compliance = 0., c = 0.;
      B_->for_row(i,
                  [&](const unsigned int column, const double value)
                  {
                    square += value * value;
                    compliance += value * value / column_diagonal[column];
                  });
      C_->for_row(i,
                  [&](const unsigned int column, const double value)
                  {
                    if (C_->columns()[column] == m_ownership_.begin() + i)
                      c = std::abs(value);
                  });
      if (square > 0.)
      {
        stiffness_[i] = square / compliance;
        scale_[i]     = std::sqrt(square) / compliance;
        if (c > 0.) // a slip row may have next to no coupling: then C sets the scale
          scale_[i] = std::min(scale_[i], std::sqrt(stiffness_[i] / c));
      }
      else if (c > 0.)
        scale_[i] = std::sqrt(mean / c);
    }
    B_->scale_rows(scale_);
    C_->scale_rows(scale_);
    C_->scale_columns(scale_);
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
    const auto make = [](std::vector<MatrixEntry> &entries, const Ownership &range, const Ownership &domain)
    { return std::make_unique<CouplingMatrix>(range.exchange(std::move(entries)), range, domain); };
    variation_.uu = make(uu, u_ownership_, u_ownership_);
    variation_.um = make(um, u_ownership_, m_ownership_);
    variation_.mu = make(mu, m_ownership_, u_ownership_);
    variation_.mm = make(mm, m_ownership_, m_ownership_);
    variation_.um->scale_columns(scale_);
    variation_.mu->scale_rows(scale_);
    variation_.mm->scale_rows(scale_);
    variation_.mm->scale_columns(scale_);
  }

  void SaddlePointOperator::apply_stiffness(const double *const u, double *const f) const
  {
    bulk().vmult(f, u);
    add_coupling(u, f);
  }

  void SaddlePointOperator::add_coupling(const double *const u, double *const f) const
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
    const double *const u = src.block(0).begin(), *const m = src.block(1).begin();
    double *const f = dst.block(0).begin(), *const g = dst.block(1).begin();

    apply_stiffness(u, f);
    B_->add_transposed_product(m, f);
    std::fill_n(g, m_ownership_.end() - m_ownership_.begin(), 0.);
    B_->add_product(u, g);
    C_->add_product(m, g, -1.);
    if (!variation_.uu)
      return;
    variation_.uu->add_product(u, f);
    variation_.um->add_product(m, f);
    variation_.mu->add_product(u, g);
    variation_.mm->add_product(m, g);
  }

  BlockVector SaddlePointOperator::scaled(const BlockVector &rhs) const
  {
    BlockVector b(std::vector<dealii::IndexSet>{system_.layout->owned[0], owned_m_}, system_.layout->communicator);
    b.block(0)                     = rhs.block(0);
    double *const       m          = b.block(1).begin();
    const double *const normal     = rhs.block(1).begin();
    const double *const tangential = rhs.block(2).begin();
    for (unsigned int k = 0; k < rhs.block(1).locally_owned_size(); ++k)
    {
      m[3 * k]     = scale_[3 * k] * normal[k];
      m[3 * k + 1] = scale_[3 * k + 1] * tangential[2 * k];
      m[3 * k + 2] = scale_[3 * k + 2] * tangential[2 * k + 1];
    }
    return b;
  }

  void SaddlePointOperator::to_solution(const BlockVector &x, BlockVector &solution) const
  {
    system_.layout->reinit(solution);
    solution.block(0)              = x.block(0);
    const double *const m          = x.block(1).begin();
    double *const       normal     = solution.block(1).begin();
    double *const       tangential = solution.block(2).begin();
    for (unsigned int k = 0; k < solution.block(1).locally_owned_size(); ++k)
    {
      normal[k]             = scale_[3 * k] * m[3 * k];
      tangential[2 * k]     = scale_[3 * k + 1] * m[3 * k + 1];
      tangential[2 * k + 1] = scale_[3 * k + 2] * m[3 * k + 2];
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
        throw SolverFailure(solver + ": the right-hand side holds a value that is not finite",
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
    const Vector &m   = residual.block(1);
    double        sum = 0.;
    for (unsigned int i = 0; i < m.locally_owned_size(); ++i)
      sum += (m.local_element(i) / scale_[i]) * (m.local_element(i) / scale_[i]);
    return std::sqrt(dealii::Utilities::MPI::sum(sum, system_.layout->communicator) + residual.block(0).norm_sqr());
  }
} // namespace Nodus
