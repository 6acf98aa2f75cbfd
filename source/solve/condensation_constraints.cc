#include "solve/condensation.h"
#include "solve/constraint_cluster.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <set>

// Which rows of B at the slave nodes are constraints and the bases of displacements that they give, constraints that
// act on slave nodes of other ones, and the form of the condensed matrix that multigrid takes.

namespace Nodus
{
  namespace
  {
    using Matrix3 = Eigen::Matrix3d;

    /// A row b of B is a constraint, to working precision, where its stiffness b b^T/c exceeds that of the node this
    /// many times.
    constexpr double constraint_stiffness = 1e10;

    /// Adds to the @p n columns of an orthonormal basis the part of @p v beside them, unless it is shorter than @p
    /// tolerance times v.
    bool add_direction(Eigen::Vector3d v, const double tolerance, Matrix3 &basis, unsigned int &n)
    {
      const double norm = v.norm();
      for (unsigned int repeat = 0; repeat < 2; ++repeat)
        for (unsigned int d = 0; d < n; ++d)
          v -= basis.col(d).dot(v) * basis.col(d);
      if (n == 3 || !(v.norm() > tolerance * norm))
        return false;
      basis.col(n++) = v.normalized();
      return true;
    }
  } // namespace

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
        classify(k, eigen.eigenvalues().asDiagonal());
      }
      catch (const NotCondensable &error)
      {
        failure = error.what();
      }
    }
    if (failure.empty() && !join_sites_of_nodes())
      failure = "the constraints of a slave node depend on each other";
    if (dealii::Utilities::MPI::max(failure.empty() ? 0 : 1, nodes_.communicator()) != 0)
      throw NotCondensable(failure.empty() ? "another process has constraints that cannot be condensed" : failure);
    const bool here = std::any_of(sites_.begin(), sites_.end(), [](const Site &site) { return site.has_spring; });
    has_springs_    = dealii::Utilities::MPI::max(here ? 1 : 0, nodes_.communicator()) != 0;
  }

  /// Finds the constraints of a site and its basis (theory section 25): directions of the constraints, those of stiff
  /// rows, prescribed displacements, and what is left.
  void Condensation::classify(const unsigned int k, const Matrix3 &C)
  {
    Site                 &site = sites_[k];
    const BlockCsrMatrix &K    = system_.bulk();
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

    unsigned int n = 0;
    for (const Kind wanted : {Kind::constraint, Kind::stiff})
    {
      for (unsigned int i = 0; i < 3; ++i)
        if (kind[i] == wanted)
        {
          if (add_direction(own.row(i).transpose(), 1e-6, site.basis, n))
            site.combination[n - 1] = {k, i};
          else if (wanted == Kind::constraint)
            throw NotCondensable("the constraints of a slave node depend on each other");
        }
      if (wanted == Kind::constraint)
        site.n_constraints = n;
    }
    site.n_directions = n;
    complete_basis(site, n);
  }

  /// Fills the columns from @p n on: prescribed displacements, and what is left.
  void Condensation::complete_basis(Site &site, unsigned int n) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (system_.bulk().decoupled(dim * site.node + d))
        add_direction(Eigen::Vector3d::Unit(d), 0.999, site.basis, n);
    for (unsigned int d = 0; d < dim; ++d)
      add_direction(Eigen::Vector3d::Unit(d), 0.4, site.basis, n);
    for (unsigned int d = 0; d < dim && n < dim; ++d)
      add_direction(Eigen::Vector3d::Unit(d), 1e-3, site.basis, n);
  }

  /// Where several sites of a node have directions, the first one takes the constraints of all of them; stiff rows then
  /// have none. Returns whether the constraints of each node are independent.
  bool Condensation::join_sites_of_nodes()
  {
    for (unsigned int begin = 0, end = 0; begin < sites_.size(); begin = end)
    {
      std::vector<unsigned int> with_directions;
      for (; end < sites_.size() && sites_[end].node == sites_[begin].node; ++end)
        if (sites_[end].n_directions > 0)
          with_directions.push_back(end);
      if (with_directions.size() < 2)
        continue;
      Site                  &first = sites_[with_directions.front()];
      std::vector<TurnedRow> constraints;
      for (const unsigned int k : with_directions)
      {
        Site &site = sites_[k];
        constraints.insert(constraints.end(), site.combination, site.combination + site.n_constraints);
        site.n_constraints = site.n_directions = 0;
      }
      for (const TurnedRow &constraint : constraints)
      {
        const auto own = sites_[constraint.site].rows.front().block.row(constraint.row);
        if (!add_direction(own.transpose(), 1e-6, first.basis, first.n_constraints))
          return false;
        first.combination[first.n_constraints - 1] = constraint;
      }
      first.n_directions = first.n_constraints;
      first.coupled      = first.n_constraints > 0;
      complete_basis(first, first.n_constraints);
    }
    return true;
  }

  void Condensation::find_coupled_sites()
  {
    std::map<unsigned int, Site *> site_of; // by local node
    for (Site &site : sites_)
      if (site.n_constraints > 0)
        site_of[site.node] = &site;
    const auto n_constraints = [&](const unsigned int node)
    {
      const auto found = site_of.find(node);
      return found == site_of.end() ? 0u : found->second->n_constraints;
    };

    // calls f(node, row) for the rows of a site's constraints at other nodes
    const auto for_each_coupling = [&](const Site &site, const auto &f)
    {
      for (unsigned int d = 0; d < site.n_constraints; ++d)
        for (unsigned int k = 1; k < sites_[site.combination[d].site].rows.size(); ++k)
        {
          const NodeBlock &coupling = sites_[site.combination[d].site].rows[k];
          f(coupling.node, coupling.block.row(site.combination[d].row));
        }
    };

    std::vector<DoFIndex> asked;
    for (const Site &site : sites_)
      for_each_coupling(site, [&](const DoFIndex node, const auto &) { asked.push_back(node); });
    std::sort(asked.begin(), asked.end());
    asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
    const auto constraints_of =
        nodes_.ask(asked, [&](const unsigned int node) { return std::vector<double>{double(n_constraints(node))}; });

    std::vector<DoFIndex> touched;
    for (Site &site : sites_)
      for_each_coupling(site,
                        [&](const DoFIndex node, const auto &row)
                        {
                          if (constraints_of.at(node)[0] > 0. && !row.isZero(0.))
                          {
                            site.coupled = true;
                            touched.push_back(node);
                          }
                        });
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    nodes_.ask(touched,
               [&](const unsigned int node)
               {
                 site_of.at(node)->coupled = true;
                 return std::vector<double>();
               });
    for (Site &site : sites_)
      if (site.coupled)
        site.n_directions = site.n_constraints;
  }

  /// Eliminates the constraints of coupled sites together.
  void Condensation::make_cluster()
  {
    std::vector<ConstraintCluster::Member> members;
    for (unsigned int k = 0; k < sites_.size(); ++k)
    {
      const Site &site = sites_[k];
      if (!site.coupled)
        continue;
      members.push_back({k, nodes_.global(site.node), site.n_constraints, site.basis, {}});
      std::set<unsigned int> from; // sites of the node
      for (unsigned int d = 0; d < site.n_constraints; ++d)
        from.insert(site.combination[d].site);
      for (const unsigned int other : from)
        for (const NodeBlock &coupling : sites_[other].rows)
        {
          Matrix3 rows = Matrix3::Zero();
          for (unsigned int d = 0; d < site.n_constraints; ++d)
            if (site.combination[d].site == other)
              rows.row(d) = coupling.block.row(site.combination[d].row);
          members.back().rows.push_back({coupling.node, rows});
        }
    }
    cluster_ = ConstraintCluster::make(members, nodes_.communicator());
    if (!cluster_)
      return;
    if (!cluster_->regular())
      throw NotCondensable("the constraints of neighbouring slave nodes depend on each other");
    for (const auto &member : members)
      if (Row *const row = rows_[sites_[member.site].node].get())
      {
        for (const auto &[node, block] : cluster_->substitution(member))
          if (node == member.node)
            row->own += block;
          else
            row->others.push_back({node, block});
      }
  }

  Condensation::Matrix3 Condensation::stiffness_along_rows(const Site &site) const
  {
    const Matrix3 D        = site.flexibility_inverse.asDiagonal();
    const Matrix3 friction = system_.own_coupling(nodes_.global(site.node));
    // of a node of several sites it is not known which part belongs to whose rows
    if (friction.isZero(0.) || system_.shares_node(&site - sites_.data()))
      return D;
    // the rows of friction span the plane in which C_uu acts
    const Matrix3 inverse = site.rows.front().block.completeOrthogonalDecomposition().pseudoInverse();
    Matrix3       along   = inverse.transpose() * friction * inverse;
    for (unsigned int i = 0; i < 3; ++i)
      if (site.flexibility_inverse[i] == 0.)
      {
        along.row(i).setZero();
        along.col(i).setZero();
      }
    return D + along;
  }

  NodeRow Condensation::transformed_rows(const Site &site) const
  {
    std::map<DoFIndex, Matrix3> rows;
    const auto                  add = [&](const DoFIndex node, const Matrix3 &block)
    { rows.try_emplace(node, Matrix3::Zero()).first->second += block; };
    for (const NodeBlock &coupling : site.rows)
    {
      const unsigned int local = nodes_.local(coupling.node);
      const Row         *row   = local == dealii::numbers::invalid_unsigned_int ? nullptr : rows_[local].get();
      if (!row)
      {
        add(coupling.node, coupling.block);
        continue;
      }
      add(coupling.node, coupling.block * row->own);
      for (const NodeBlock &other : row->others)
        add(other.node, coupling.block * other.block);
    }
    NodeRow result;
    for (const auto &[node, block] : rows)
      result.emplace_back(node, by_rows(block));
    return result;
  }

  Constraints Condensation::constraints() const
  {
    Constraints constraints;
    constraints.T        = T_;
    constraints.diagonal = eliminated_;
    for (const Site &site : sites_)
      if (site.has_spring)
        constraints.springs.push_back({transformed_rows(site), by_rows(stiffness_along_rows(site))});
    return constraints;
  }
} // namespace Nodus
