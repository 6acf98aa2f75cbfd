#include "solve/condensation.h"
#include "solve/constraint_cluster.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    using Matrix3 = Eigen::Matrix3d;

    /// A row b of B is a constraint, to working precision, where its stiffness b b^T/c exceeds that of the node this
    /// many times.
    constexpr double constraint_stiffness = 1e10;
  } // namespace

  Condensation::Condensation(const SaddlePointOperator &system)
      : system_(system)
      , nodes_(system.bulk().map())
      , u_(dim * nodes_.n_owned())
      , f_(dim * nodes_.n_owned())
      , multiplier_(3 * system.slave_nodes().size())
  {
    rows_.resize(nodes_.size());
    make_sites();
    find_coupled_sites();
    make_rows();
    make_cluster();
    fetch_ghost_rows();
    make_transformation();
  }

  Condensation::~Condensation() = default;

  void Condensation::make_sites()
  {
    const CouplingMatrix &B = system_.B(), &C = system_.C();
    const DoFIndex        first_multiplier = system_.multiplier_ownership().begin();
    std::string           failure;
    sites_.resize(system_.slave_nodes().size());
    for (unsigned int k = 0; k < sites_.size() && failure.empty(); ++k)
    {
      Site &site                         = sites_[k];
      site.node                          = nodes_.local(system_.slave_nodes()[k]);
      Matrix3                     C_node = Matrix3::Zero();
      std::map<DoFIndex, Matrix3> blocks;
      blocks[system_.slave_nodes()[k]].setZero();
      for (unsigned int a = 0; a < 3; ++a)
      {
        C.for_row(3 * k + a,
                  [&](const unsigned int column, const double value)
                  {
                    // as signed numbers: the multiplier may be of a node before this one
                    const auto b = static_cast<std::int64_t>(C.columns()[column]) -
                                   static_cast<std::int64_t>(first_multiplier + 3 * k);
                    if (b >= 0 && b < 3)
                      C_node(a, b) += value;
                    else if (value != 0.)
                      failure = "the multipliers of different slave nodes are coupled";
                  });
        B.for_row(3 * k + a,
                  [&](const unsigned int column, const double value)
                  {
                    const DoFIndex dof = B.columns()[column];
                    blocks.try_emplace(dof / dim, Matrix3::Zero()).first->second(a, dof % dim) += value;
                  });
      }
      const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(C_node);
      site.turn = eigen.eigenvectors();
      site.rows.push_back({system_.slave_nodes()[k], site.turn.transpose() * blocks[system_.slave_nodes()[k]]});
      for (const auto &[node, block] : blocks)
        if (node != system_.slave_nodes()[k])
          site.rows.push_back({node, site.turn.transpose() * block});
      try
      {
        classify(site, eigen.eigenvalues().asDiagonal());
      }
      catch (const NotCondensable &error)
      {
        failure = error.what();
      }
    }
    if (dealii::Utilities::MPI::max(failure.empty() ? 0 : 1, nodes_.communicator()) != 0)
      throw NotCondensable(failure.empty() ? "another process has constraints that cannot be condensed" : failure);
    const bool here = std::any_of(sites_.begin(), sites_.end(), [](const Site &site) { return site.has_spring; });
    has_springs_    = dealii::Utilities::MPI::max(here ? 1 : 0, nodes_.communicator()) != 0;
  }

  /// Finds the constraints of a site and its basis (theory section 25): directions of the constraints, those of stiff
  /// rows, prescribed displacements, and what is left.
  void Condensation::classify(Site &site, const Matrix3 &C) const
  {
    const BlockCsrMatrix &K = system_.bulk();
    for (unsigned int d = 0; d < dim; ++d)
      site.diagonal += std::abs(K.diagonal(site.node)[4 * d]) / dim;
    const Matrix3 &own = site.rows.front().block;

    enum class Kind
    {
      constraint,
      stiff,
      soft
    } kind[3];
    for (unsigned int i = 0; i < 3; ++i)
    {
      double square = 0.;
      for (const NodeBlock &coupling : site.rows)
        square += coupling.block.row(i).squaredNorm();
      const double c         = C(i, i);
      const bool   rigid     = square > 0. && constraint_stiffness * std::abs(c) * site.diagonal <= square;
      const double stiffness = own.row(i).squaredNorm();
      if (rigid && stiffness < 1e-12 * square)
        throw NotCondensable("a slave node is held where its contact constraint acts");
      if (!rigid && square > 0. && c < 0.)
        throw NotCondensable("a friction law gives way: its compliance is negative");
      kind[i] = Kind::soft;
      if (rigid)
        kind[i] = Kind::constraint;
      else if (stiffness > c * site.diagonal)
        kind[i] = Kind::stiff;
      site.flexibility_inverse[i] = rigid || c == 0. ? 0. : 1. / c;
      site.has_spring             = site.has_spring || (site.flexibility_inverse[i] != 0. && square > 0.);
    }

    unsigned int n   = 0;
    const auto   add = [&](Eigen::Vector3d v, const double tolerance)
    {
      const double norm = v.norm();
      for (unsigned int repeat = 0; repeat < 2; ++repeat)
        for (unsigned int d = 0; d < n; ++d)
          v -= site.basis.col(d).dot(v) * site.basis.col(d);
      if (n == 3 || !(v.norm() > tolerance * norm))
        return false;
      site.basis.col(n++) = v.normalized();
      return true;
    };
    for (const Kind wanted : {Kind::constraint, Kind::stiff})
    {
      for (unsigned int i = 0; i < 3; ++i)
        if (kind[i] == wanted)
        {
          if (add(own.row(i).transpose(), 1e-6))
            site.combination[n - 1] = i;
          else if (wanted == Kind::constraint)
            throw NotCondensable("the constraints of a slave node depend on each other");
        }
      if (wanted == Kind::constraint)
        site.n_constraints = n;
    }
    site.n_directions = n;
    for (unsigned int d = 0; d < dim; ++d)
      if (K.decoupled(dim * site.node + d))
        add(Eigen::Vector3d::Unit(d), 0.999);
    for (unsigned int d = 0; d < dim; ++d)
      add(Eigen::Vector3d::Unit(d), 0.4);
    for (unsigned int d = 0; d < dim && n < dim; ++d)
      add(Eigen::Vector3d::Unit(d), 1e-3);
  }

  Condensation::Matrix3 Condensation::constraint_inverse(const Site &site, const unsigned int n) const
  {
    Matrix3 H = Matrix3::Identity();
    for (unsigned int d = 0; d < n; ++d)
      for (unsigned int e = 0; e < n; ++e)
        H(d, e) = site.rows.front().block.row(site.combination[d]).dot(site.basis.col(e));
    Matrix3 inverse = H.inverse();
    for (unsigned int d = n; d < dim; ++d)
      inverse(d, d) = 0.;
    return inverse;
  }

  /// The rows of T at slave nodes (eq. D2). Those of coupled sites are completed by make_cluster().
  void Condensation::make_rows()
  {
    for (const Site &site : sites_)
    {
      if (site.n_directions == 0)
        continue;
      auto row = std::make_unique<Row>();
      row->own = site.basis;
      for (unsigned int d = 0; d < site.n_constraints; ++d)
        row->own.col(d).setZero();
      if (!site.coupled)
      {
        const Matrix3 combine = site.basis * constraint_inverse(site, site.n_directions);
        for (unsigned int k = 1; k < site.rows.size(); ++k)
        {
          Matrix3 rows = Matrix3::Zero();
          for (unsigned int d = 0; d < site.n_directions; ++d)
            rows.row(d) = site.rows[k].block.row(site.combination[d]);
          const Matrix3 N = -combine * rows;
          if (!N.isZero(0.))
            row->others.push_back({site.rows[k].node, N});
        }
      }
      rows_[site.node] = std::move(row);
      for (unsigned int d = 0; d < site.n_constraints; ++d)
        eliminated_.emplace_back(dim * site.node + d, site.diagonal);
    }
  }

  void Condensation::fetch_ghost_rows()
  {
    const auto lists = nodes_.lists_at_ghosts(
        [&](const unsigned int node, std::vector<double> &numbers)
        {
          if (const Row *row = rows_[node].get())
          {
            append(numbers, row->own);
            for (const NodeBlock &other : row->others)
            {
              numbers.push_back(other.node);
              append(numbers, other.block);
            }
          }
        });
    for (unsigned int g = 0; g < lists.size(); ++g)
      if (!lists[g].empty())
      {
        auto          row = std::make_unique<Row>();
        const double *p   = lists[g].data();
        row->own          = read(p);
        while (p != lists[g].data() + lists[g].size())
        {
          const auto other = static_cast<DoFIndex>(*p++);
          row->others.push_back({other, read(p)});
        }
        rows_[nodes_.n_owned() + g] = std::move(row);
      }
  }

  void Condensation::make_transformation()
  {
    std::vector<std::pair<unsigned int, NodeRow>> rows;
    std::vector<unsigned int>                     replaced;
    unsigned int                                  n_owned = 0;
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      if (const Row *const row = rows_[i].get())
      {
        replaced.push_back(i);
        n_owned += i < nodes_.n_owned();
        NodeRow &blocks = rows.emplace_back(i, NodeRow()).second;
        blocks.emplace_back(nodes_.global(i), by_rows(row->own));
        for (const NodeBlock &other : row->others)
          blocks.emplace_back(other.node, by_rows(other.block));
      }
    replaced_ = std::make_unique<BlockCsrRows>(system_.bulk(), std::move(replaced));
    T_        = std::make_shared<const Transformation>(std::move(rows), n_owned, system_.displacement_ownership());
  }

  void Condensation::apply_stiffness(double *const m) const
  {
    for (unsigned int k = 0; k < sites_.size(); ++k)
    {
      Eigen::Map<Eigen::Vector3d> values(m + 3 * k);
      const Site                 &site = sites_[k];
      values = (site.turn * site.flexibility_inverse.asDiagonal() * (site.turn.transpose() * values)).eval();
    }
  }

  void Condensation::add_springs(const double *const u, double *const f) const
  {
    if (!has_springs_)
      return;
    std::fill(multiplier_.begin(), multiplier_.end(), 0.);
    system_.B().add_product(u, multiplier_.data());
    apply_stiffness(multiplier_.data());
    system_.B().add_transposed_product(multiplier_.data(), f);
  }

  void Condensation::apply_transformation(const double *const y, double *const u) const
  {
    std::copy_n(y, u_.size(), u);
    T_->apply(u);
  }

  void Condensation::apply_transposed(const double *const f, double *const y) const
  {
    std::copy_n(f, f_.size(), y);
    T_->apply_transposed(y);
  }

  void Condensation::vmult(Vector &y, const Vector &x) const
  {
    double *const       result = y.begin();
    const double *const given  = x.begin();
    apply_transformation(given, u_.data());
    system_.apply_stiffness(u_.data(), f_.data());
    add_springs(u_.data(), f_.data());
    apply_transposed(f_.data(), result);
    for (const auto &[i, diagonal] : eliminated_)
      result[i] = diagonal * given[i];
  }

  void Condensation::condense(const BlockVector &b, Vector &rhs)
  {
    const double *const f_b = b.block(0).begin(), *const g_b = b.block(1).begin();
    particular_.assign(dim * nodes_.n_owned(), 0.);
    std::vector<Eigen::Vector3d> y(sites_.size(), Eigen::Vector3d::Zero());
    for (unsigned int k = 0; k < sites_.size(); ++k)
    {
      const Site           &site = sites_[k];
      const Eigen::Vector3d g    = site.turn.transpose() * Eigen::Map<const Eigen::Vector3d>(g_b + 3 * k);
      for (unsigned int d = 0; d < site.n_constraints; ++d)
        y[k][d] = g[site.combination[d]];
      if (!site.coupled)
        y[k] = (constraint_inverse(site, site.n_constraints) * y[k]).eval();
    }
    if (cluster_)
      cluster_->solve(y, false);
    for (unsigned int k = 0; k < sites_.size(); ++k)
    {
      const Eigen::Vector3d u = sites_[k].basis * y[k];
      for (unsigned int c = 0; c < dim && sites_[k].n_constraints > 0; ++c)
        particular_[dim * sites_[k].node + c] = u[c];
    }

    const double *const u_g = particular_.data();
    replaced_->vmult_columns(f_.data(), u_g);
    system_.add_coupling(u_g, f_.data());
    add_springs(u_g, f_.data());
    for (std::size_t i = 0; i < f_.size(); ++i)
      f_[i] = f_b[i] - f_[i];
    if (has_springs_)
    {
      std::copy_n(g_b, multiplier_.size(), multiplier_.begin());
      apply_stiffness(multiplier_.data());
      system_.B().add_transposed_product(multiplier_.data(), f_.data());
    }
    double *const condensed = rhs.begin();
    apply_transposed(f_.data(), condensed);
    for (const auto &[i, diagonal] : eliminated_)
      condensed[i] = 0.;
  }

  void Condensation::expand(const Vector &y, const BlockVector &b, BlockVector &x) const
  {
    double *const u = x.block(0).begin(), *const m = x.block(1).begin();
    const double *const f_b = b.block(0).begin(), *const g_b = b.block(1).begin();
    apply_transformation(y.begin(), u);
    for (std::size_t i = 0; i < u_.size(); ++i)
      u[i] += particular_[i];

    // m = D (B u - g), and what is left of equilibrium goes to the constraints (eq. D3)
    replaced_->vmult(f_.data(), u);
    system_.add_coupling(u, f_.data());
    for (std::size_t i = 0; i < multiplier_.size(); ++i)
      m[i] = -g_b[i];
    if (has_springs_)
      system_.B().add_product(u, m);
    apply_stiffness(m);
    for (std::size_t i = 0; i < f_.size(); ++i)
      f_[i] = f_b[i] - f_[i];
    if (has_springs_)
      system_.B().add_transposed_product(m, f_.data(), -1.);
    std::vector<Eigen::Vector3d> force(sites_.size(), Eigen::Vector3d::Zero());
    for (unsigned int k = 0; k < sites_.size(); ++k)
    {
      const Site &site = sites_[k];
      force[k]         = site.basis.transpose() * Eigen::Map<const Eigen::Vector3d>(f_.data() + dim * site.node);
      if (!site.coupled)
        force[k] = (constraint_inverse(site, site.n_constraints).transpose() * force[k]).eval();
    }
    if (cluster_)
      cluster_->solve(force, true);
    for (unsigned int k = 0; k < sites_.size(); ++k)
      for (unsigned int d = 0; d < sites_[k].n_constraints; ++d)
        Eigen::Map<Eigen::Vector3d>(m + 3 * k) += force[k][d] * sites_[k].turn.col(sites_[k].combination[d]);
  }

  void Condensation::transform_modes(std::vector<double> &modes) const
  {
    const std::size_t n = dim * nodes_.n_owned();
    for (const Site &site : sites_)
      if (site.n_directions > 0)
        for (unsigned int mode = 0; mode < 6; ++mode)
        {
          Eigen::Map<Eigen::Vector3d> values(modes.data() + mode * n + dim * site.node);
          values = (site.basis.transpose() * values).eval();
          for (unsigned int d = 0; d < site.n_directions; ++d)
            values[d] = 0.;
        }
  }

  std::vector<char> Condensation::signature() const
  {
    std::vector<char> result;
    for (const Site &site : sites_)
      result.push_back(site.n_constraints + 4 * site.n_directions);
    return result;
  }
} // namespace Nodus
