#include "solve/condensation.h"
#include "solve/constraint_cluster.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

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
        for (const Coupling &coupling : site.rows)
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

  void Condensation::make_cluster()
  {
    // node, number of constraints, basis, and per coupled node: node and its three columns of the constraint rows
    std::vector<double> mine;
    for (const Site &site : sites_)
      if (site.coupled)
      {
        mine.push_back(nodes_.global(site.node));
        mine.push_back(site.n_constraints);
        append(mine, site.basis);
        mine.push_back(site.rows.size());
        for (const Coupling &coupling : site.rows)
        {
          mine.push_back(coupling.node);
          Matrix3 rows = Matrix3::Zero();
          for (unsigned int d = 0; d < site.n_constraints; ++d)
            rows.row(d) = coupling.block.row(site.combination[d]);
          append(mine, rows);
        }
      }
    if (dealii::Utilities::MPI::max(mine.empty() ? 0 : 1, nodes_.communicator()) == 0)
      return;

    struct Member
    {
      DoFIndex              node;
      unsigned int          n_constraints;
      Matrix3               basis;
      std::vector<Coupling> rows;
    };
    std::vector<Member> members;
    cluster_ = std::make_unique<ConstraintCluster>();
    for (const auto &part : dealii::Utilities::MPI::all_gather(nodes_.communicator(), mine))
    {
      cluster_->n_ranks += !part.empty();
      for (const double *p = part.data(); p != part.data() + part.size();)
      {
        Member member;
        member.node          = static_cast<DoFIndex>(*p++);
        member.n_constraints = static_cast<unsigned int>(*p++);
        member.basis         = read(p);
        const auto n         = static_cast<unsigned int>(*p++);
        for (unsigned int k = 0; k < n; ++k)
        {
          const auto node = static_cast<DoFIndex>(*p++);
          member.rows.push_back({node, read(p)});
        }
        cluster_->first[member.node] = cluster_->size;
        cluster_->size += member.n_constraints;
        members.push_back(std::move(member));
      }
    }
    std::map<DoFIndex, const Member *> member_of;
    for (const Member &member : members)
      member_of[member.node] = &member;

    std::vector<Eigen::Triplet<double>> M;
    cluster_->others.resize(cluster_->size);
    for (const Member &member : members)
      for (const Coupling &coupling : member.rows)
        for (unsigned int d = 0; d < member.n_constraints; ++d)
        {
          const unsigned int row = cluster_->first[member.node] + d;
          Eigen::RowVector3d b   = coupling.block.row(d);
          if (const auto found = member_of.find(coupling.node); found != member_of.end())
          {
            const Member &other = *found->second;
            b                   = (b * other.basis).eval();
            for (unsigned int e = 0; e < other.n_constraints; ++e)
            {
              if (b[e] != 0.)
                M.emplace_back(row, cluster_->first[other.node] + e, b[e]);
              b[e] = 0.;
            }
          }
          if (!b.isZero(0.))
            cluster_->others[row].emplace_back(coupling.node, b);
        }
    Eigen::SparseMatrix<double> matrix(cluster_->size, cluster_->size);
    matrix.setFromTriplets(M.begin(), M.end());
    cluster_->M.compute(matrix);
    const Eigen::SparseMatrix<double> transposed = matrix.transpose();
    cluster_->M_transposed.compute(transposed);
    if (cluster_->M.info() != Eigen::Success || cluster_->M_transposed.info() != Eigen::Success)
      throw NotCondensable("the constraints of neighbouring slave nodes depend on each other");

    // y_c = M^-1 (g - R y): rows of M^-1 for the sites owned here; they decay quickly from node to node
    for (const Site &site : sites_)
      if (site.coupled && rows_[site.node])
      {
        Row                        &row = *rows_[site.node];
        std::map<DoFIndex, Matrix3> sum;
        for (unsigned int d = 0; d < site.n_constraints; ++d)
        {
          Eigen::VectorXd unit                                = Eigen::VectorXd::Zero(cluster_->size);
          unit[cluster_->first[nodes_.global(site.node)] + d] = 1.;
          const Eigen::VectorXd inverse                       = cluster_->M_transposed.solve(unit);
          const double          largest                       = inverse.cwiseAbs().maxCoeff();
          for (unsigned int r = 0; r < cluster_->size; ++r)
            if (std::abs(inverse[r]) > 1e-16 * largest)
              for (const auto &[node, b] : cluster_->others[r])
                sum.try_emplace(node, Matrix3::Zero()).first->second -= site.basis.col(d) * (inverse[r] * b);
        }
        for (const auto &[node, block] : sum)
          if (node == nodes_.global(site.node))
            row.own += block;
          else
            row.others.push_back({node, block});
      }
  }

  void Condensation::solve_cluster(std::vector<Eigen::Vector3d> &values, const bool transposed) const
  {
    if (cluster_->n_ranks == 1 && std::none_of(sites_.begin(), sites_.end(), [](const Site &s) { return s.coupled; }))
      return;
    std::vector<double> all(cluster_->size, 0.);
    for (unsigned int k = 0; k < sites_.size(); ++k)
      for (unsigned int d = 0; d < sites_[k].n_constraints && sites_[k].coupled; ++d)
        all[cluster_->first.at(nodes_.global(sites_[k].node)) + d] = values[k][d];
    if (cluster_->n_ranks > 1)
      dealii::Utilities::MPI::sum(all, nodes_.communicator(), all);
    const Eigen::VectorXd b = Eigen::Map<Eigen::VectorXd>(all.data(), all.size());
    const Eigen::VectorXd x = transposed ? cluster_->M_transposed.solve(b).eval() : cluster_->M.solve(b).eval();
    for (unsigned int k = 0; k < sites_.size(); ++k)
      for (unsigned int d = 0; d < sites_[k].n_constraints && sites_[k].coupled; ++d)
        values[k][d] = x[cluster_->first.at(nodes_.global(sites_[k].node)) + d];
  }
} // namespace Nodus
