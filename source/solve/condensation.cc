#include "solve/condensation.h"
#include "solve/constraint_cluster.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
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

  Condensation::Matrix3 Condensation::constraint_inverse(const Site &site, const unsigned int n) const
  {
    Matrix3 H = Matrix3::Identity();
    for (unsigned int d = 0; d < n; ++d)
      for (unsigned int e = 0; e < n; ++e)
        H(d, e) = site.rows.front().block.row(site.combination[d].row).dot(site.basis.col(e));
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
            rows.row(d) = site.rows[k].block.row(site.combination[d].row);
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
      const Site &site = sites_[k];
      for (unsigned int d = 0; d < site.n_constraints; ++d)
      {
        const auto [from, row] = site.combination[d];
        y[k][d]                = sites_[from].turn.col(row).dot(Eigen::Map<const Eigen::Vector3d>(g_b + 3 * from));
      }
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
      {
        const auto [to, row] = sites_[k].combination[d];
        Eigen::Map<Eigen::Vector3d>(m + 3 * to) += force[k][d] * sites_[to].turn.col(row);
      }
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
