#include "solve/condensation.h"
#include "solve/constraint_cluster.h"

#include <algorithm>

// Constraints that act on slave nodes of other constraints, and the form of the condensed matrix that multigrid takes.

namespace Nodus
{
  void Condensation::find_coupled_sites()
  {
    std::map<unsigned int, Site *> site_of; // by local node
    for (Site &site : sites_)
      site_of[site.node] = &site;
    const auto n_constraints = [&](const unsigned int node)
    {
      const auto found = site_of.find(node);
      return found == site_of.end() ? 0u : found->second->n_constraints;
    };

    std::vector<DoFIndex> asked;
    for (const Site &site : sites_)
      if (site.n_constraints > 0)
        for (const NodeBlock &coupling : site.rows)
          asked.push_back(coupling.node);
    std::sort(asked.begin(), asked.end());
    asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
    const auto constraints_of =
        nodes_.ask(asked, [&](const unsigned int node) { return std::vector<double>{double(n_constraints(node))}; });

    std::vector<DoFIndex> touched;
    for (Site &site : sites_)
      for (unsigned int k = 1; k < site.rows.size() && site.n_constraints > 0; ++k)
        if (constraints_of.at(site.rows[k].node)[0] > 0.)
        {
          bool acts = false;
          for (unsigned int d = 0; d < site.n_constraints; ++d)
            acts = acts || !site.rows[k].block.row(site.combination[d]).isZero(0.);
          if (acts)
          {
            site.coupled = true;
            touched.push_back(site.rows[k].node);
          }
        }
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
      for (const NodeBlock &coupling : site.rows)
      {
        Matrix3 rows = Matrix3::Zero();
        for (unsigned int d = 0; d < site.n_constraints; ++d)
          rows.row(d) = coupling.block.row(site.combination[d]);
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
    if (friction.isZero(0.))
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
