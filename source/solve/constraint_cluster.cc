#include "solve/constraint_cluster.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace Nodus
{
  using Eigen::Matrix3d;

  std::unique_ptr<ConstraintCluster> ConstraintCluster::make(const std::vector<Member> &mine,
                                                             const MPI_Comm             communicator)
  {
    if (dealii::Utilities::MPI::max(mine.empty() ? 0 : 1, communicator) == 0)
      return nullptr;
    return std::unique_ptr<ConstraintCluster>(new ConstraintCluster(mine, communicator));
  }

  ConstraintCluster::ConstraintCluster(const std::vector<Member> &mine, const MPI_Comm communicator)
      : communicator_(communicator)
  {
    collect(mine);
    for (const Member &member : mine)
      own_.push_back({member.site, first_.at(member.node), member.n_constraints});
    const Matrix M = assemble();
    members_       = std::vector<Member>();
    M_.compute(M);
    const Matrix transposed = M.transpose();
    M_transposed_.compute(transposed);
  }

  /// Brings the members of all ranks here and numbers their constraints.
  void ConstraintCluster::collect(const std::vector<Member> &mine)
  {
    // node, number of constraints, basis, number of coupled nodes, and for each of them node and block
    std::vector<double> numbers;
    for (const Member &member : mine)
    {
      numbers.push_back(member.node);
      numbers.push_back(member.n_constraints);
      append(numbers, member.basis);
      numbers.push_back(member.rows.size());
      for (const NodeBlock &coupling : member.rows)
      {
        numbers.push_back(coupling.node);
        append(numbers, coupling.block);
      }
    }
    for (const auto &part : all_gather(communicator_, numbers))
    {
      n_ranks_ += !part.empty();
      for (const double *p = part.data(); p != part.data() + part.size();)
      {
        Member member;
        member.site          = dealii::numbers::invalid_unsigned_int; // of another rank, perhaps
        member.node          = static_cast<DoFIndex>(*p++);
        member.n_constraints = static_cast<unsigned int>(*p++);
        member.basis         = read(p);
        const auto n         = static_cast<unsigned int>(*p++);
        for (unsigned int k = 0; k < n; ++k)
        {
          const auto node = static_cast<DoFIndex>(*p++);
          member.rows.push_back({node, read(p)});
        }
        first_[member.node] = size_;
        size_ += member.n_constraints;
        members_.push_back(std::move(member));
      }
    }
  }

  /// Returns M and fills R_.
  ConstraintCluster::Matrix ConstraintCluster::assemble()
  {
    std::map<DoFIndex, const Member *> member_of;
    for (const Member &member : members_)
      member_of[member.node] = &member;

    std::vector<Eigen::Triplet<double>> entries;
    R_.resize(size_);
    for (const Member &member : members_)
      for (const NodeBlock &coupling : member.rows)
        for (unsigned int d = 0; d < member.n_constraints; ++d)
        {
          const unsigned int row = first_[member.node] + d;
          Eigen::RowVector3d b   = coupling.block.row(d);
          if (const auto found = member_of.find(coupling.node); found != member_of.end())
          {
            const Member &other = *found->second;
            b                   = (b * other.basis).eval();
            for (unsigned int e = 0; e < other.n_constraints; ++e)
            {
              if (b[e] != 0.)
                entries.emplace_back(row, first_[other.node] + e, b[e]);
              b[e] = 0.;
            }
          }
          if (!b.isZero(0.))
            R_[row].emplace_back(coupling.node, b);
        }
    Matrix M(size_, size_);
    M.setFromTriplets(entries.begin(), entries.end());
    return M;
  }

  bool ConstraintCluster::regular() const
  {
    return M_.info() == Eigen::Success && M_transposed_.info() == Eigen::Success;
  }

  std::map<DoFIndex, Matrix3d> ConstraintCluster::substitution(const Member &member) const
  {
    std::map<DoFIndex, Matrix3d> sum;
    for (unsigned int d = 0; d < member.n_constraints; ++d)
    {
      Eigen::VectorXd unit             = Eigen::VectorXd::Zero(size_);
      unit[first_.at(member.node) + d] = 1.;
      const Eigen::VectorXd inverse    = M_transposed_.solve(unit); // a row of M^-1
      const double          largest    = inverse.cwiseAbs().maxCoeff();
      for (unsigned int r = 0; r < size_; ++r)
        if (std::abs(inverse[r]) > 1e-16 * largest) // rows of M^-1 decay quickly from node to node
          for (const auto &[node, b] : R_[r])
            sum.try_emplace(node, Matrix3d::Zero()).first->second -= member.basis.col(d) * (inverse[r] * b);
    }
    return sum;
  }

  void ConstraintCluster::solve(std::vector<Eigen::Vector3d> &values, const bool transposed) const
  {
    if (n_ranks_ == 1 && own_.empty())
      return;
    std::vector<double> all(size_, 0.);
    for (const Own &own : own_)
      for (unsigned int d = 0; d < own.n_constraints; ++d)
        all[own.first + d] = values[own.site][d];
    if (n_ranks_ > 1)
      dealii::Utilities::MPI::sum(all, communicator_, all);
    const Eigen::VectorXd b = Eigen::Map<Eigen::VectorXd>(all.data(), all.size());
    const Eigen::VectorXd x = transposed ? M_transposed_.solve(b).eval() : M_.solve(b).eval();
    for (const Own &own : own_)
      for (unsigned int d = 0; d < own.n_constraints; ++d)
        values[own.site][d] = x[own.first + d];
  }
} // namespace Nodus
