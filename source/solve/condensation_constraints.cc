#include "solve/condensation.h"
#include "solve/constraint_cluster.h"

namespace Nodus
{
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
    for (const Coupling &coupling : site.rows)
    {
      const unsigned int local = nodes_.local(coupling.node);
      const Row         *row   = local == dealii::numbers::invalid_unsigned_int ? nullptr : rows_[local].get();
      if (!row)
      {
        add(coupling.node, coupling.block);
        continue;
      }
      add(coupling.node, coupling.block * row->own);
      for (const Coupling &other : row->others)
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
