#include "contact/contact_scatter.h"
#include "parallel/owned_values.h"
#include "parallel/wait_for_all.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  namespace
  {
    constexpr int max_unknowns = LawSum::max_unknowns;
    using LocalMatrix =
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_unknowns, max_unknowns>;
    using LocalVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_unknowns, 1>;
  } // namespace

  ContactScatter::ContactScatter(const ContactSurfaces &surfaces,
                                 const Pairing         &pairing,
                                 const JumpOperator    &jump,
                                 const ContactState    &state)
      : surfaces_(surfaces)
      , pairing_(pairing)
      , jump_(jump)
      , state_(state)
      , jump_residual_(3 * surfaces.n_sites(), 0.)
      , jump_rhs_(3 * surfaces.n_sites(), 0.)
      , law_residual_(4 * surfaces.slave_nodes().size(), 0.)
      , law_rhs_(3 * surfaces.slave_nodes().size(), 0.)
  {
    if (surfaces.layout().n_rigid > 0)
      take_shares();
  }

  /// A site may meet several bodies. Where all of its master is one of them, this turns as a whole: the turns of its
  /// nodes (eq. J5) are those of an arm that reaches to the slave.
  void ContactScatter::take_shares()
  {
    shares_of_site_.assign(1, 0);
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
    {
      if (const unsigned int section = surfaces_.section(surfaces_.pair(s));
          section != dealii::numbers::invalid_unsigned_int)
      {
        RigidShare share{s, section, Vector3(), {}}; // no body of it is rigid
        for (auto e = jump_.begin(s); e != jump_.middle(s); ++e)
          share.jump[0] -= e->weight * surfaces_.axis(section);
        shares_.push_back(share);
        shares_of_site_.push_back(shares_.size());
        continue;
      }
      const auto  &n     = jump_.normal(s);
      unsigned int whole = jump_.middle(s) == jump_.end(s) ? dealii::numbers::invalid_unsigned_int
                                                           : surfaces_.rigid_body(jump_.middle(s)->node);
      for (auto e = jump_.middle(s); e != jump_.end(s); ++e)
        if (surfaces_.rigid_body(e->node) != whole)
          whole = dealii::numbers::invalid_unsigned_int;
      for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
      {
        const unsigned int body = surfaces_.rigid_body(e->node);
        if (body == dealii::numbers::invalid_unsigned_int)
          continue;
        auto share = std::find_if(shares_.begin() + shares_of_site_.back(),
                                  shares_.end(),
                                  [body](const RigidShare &other) { return other.body == body; });
        if (share == shares_.end())
          share = shares_.insert(shares_.end(), {s, body, body == whole ? -jump_.lever(s) * n : Vector3(), {}});
        const Vector3 arm = state_.x[e->node] - state_.centre[body], turn = jump_.lever(s) * e->turn;
        share->arm += e->weight * arm;
        for (unsigned int c = 0; c < dim; ++c)
        {
          share->jump[c][c] += e->weight;
          if (body == whole || turn == Vector3())
            continue;
          Vector3 axis;
          axis[c] = 1.;
          share->jump[c] += n[c] * turn;
          share->jump[dim + c] += (dealii::cross_product_3d(axis, arm) * n) * turn;
        }
      }
      for (unsigned int i = shares_of_site_.back(); i < shares_.size(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
        {
          Vector3 axis;
          axis[c] = 1.;
          shares_[i].jump[dim + c] += dealii::cross_product_3d(axis, shares_[i].arm);
        }
      shares_of_site_.push_back(shares_.size());
    }
  }

  void ContactScatter::add_friction_weight(const ContactPoint &point, const LawPoint &law)
  {
    for (unsigned int a = 0; a < law.n_nodes; ++a)
    {
      const double threshold = law.nodes[a].status.friction ? -law.threshold : law.void_threshold;
      law_residual_[4 * point.slaves[a] + 3] += std::abs(law.nodes[a].shape) * law.weight * threshold;
    }
  }

  /// All that the local unknowns of a point consist of (eq. 35), by index in the system.
  void ContactScatter::find_unknowns(const ContactPoint &point, const LawSum &sum) const
  {
    unknowns_.clear();
    for (unsigned int a = 0; a < sum.first_node / 3; ++a)
    {
      const unsigned int s = jump_site(point, a), first = 3 * a;
      const Vector3     &n = jump_.normal(s);
      for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
      {
        const Vector3 turn = jump_.lever(s) * e->turn;
        for (unsigned int c = 0; c < dim; ++c)
        {
          if (surfaces_.fixed(e->node, c))
            continue;
          const DoFIndex dof = surfaces_.nodes()[e->node].dofs[c];
          if (turn == Vector3())
            unknowns_.push_back({dof, first + c, 1, Vector3({e->weight, 0., 0.})});
          else
          {
            unknowns_.push_back({dof, first, 3, n[c] * turn});
            unknowns_.back().part[c] += e->weight;
          }
        }
      }
      if (!shares_.empty())
        for (unsigned int i = shares_of_site_[s]; i < shares_of_site_[s + 1]; ++i)
          for (unsigned int c = 0; c < 2 * dim; ++c)
            unknowns_.push_back({surfaces_.layout().rigid(shares_[i].body, c), first, dim, shares_[i].jump[c]});
    }
    const BlockLayout &layout = surfaces_.layout();
    for (unsigned int a = 0; a < sum.n_nodes; ++a)
    {
      const DoFIndex     k     = surfaces_.multiplier(point.slaves[a]);
      const unsigned int first = sum.first_node + 3 * a;
      unknowns_.push_back({layout.lambda(k), first, 1, Vector3({1., 0., 0.})});
      for (unsigned int i = 0; i < 2; ++i)
        unknowns_.push_back({layout.Lambda(k, i), first + 1 + i, 1, Vector3({1., 0., 0.})});
    }

    std::sort(unknowns_.begin(), unknowns_.end(), [](const Unknown &u, const Unknown &v) { return u.index < v.index; });
    rows_.clear();
    for (Unknown &u : unknowns_)
    {
      if (rows_.empty() || rows_.back() != u.index)
        rows_.push_back(u.index);
      u.row = rows_.size() - 1;
    }
  }

  /// Driven rigid bodies stand in the border (eq. R4), all else in @p inner.
  inline void ContactScatter::add_entry(
      TripletMatrix &inner, const DoFIndex row, const DoFIndex column, const double value, LinearSystem &system) const
  {
    const DoFIndex size = surfaces_.layout().size();
    (row < size && column < size ? inner : system.border).add(row, column, value);
  }

  void ContactScatter::add(const ContactPoint &point, const LawSum &sum)
  {
    const double *r = sum.residual.data();
    for (unsigned int a = 0; a < sum.first_node / 3; ++a)
      for (unsigned int l = 0; l < 3; ++l)
        jump_residual_[3 * jump_site(point, a) + l] += *r++;
    for (unsigned int a = 0; a < sum.n_nodes; ++a)
      for (unsigned int l = 0; l < 3; ++l)
        law_residual_[4 * point.slaves[a] + l] += *r++;
  }

  void ContactScatter::add_tangent(const ContactPoint &point, const LawSum &sum, LinearSystem &system)
  {
    const unsigned int n = sum.n_unknowns(), n_jumps = sum.first_node / 3;
    LocalVector        prescribed = LocalVector::Zero(n);
    for (unsigned int a = 0; a < n_jumps; ++a)
    {
      const Vector3 jump = jump_.jump(jump_site(point, a), state_.prescribed);
      for (unsigned int c = 0; c < dim; ++c)
        prescribed(3 * a + c) = jump[c];
    }
    const Eigen::Map<const LocalMatrix> A(sum.matrix.data(), n, n);
    const Eigen::Map<const LocalVector> r(sum.residual.data(), n);
    const LocalVector                   rhs = -(r + A * prescribed); // eq. N2
    for (unsigned int l = 0; l < 3; ++l)
    {
      for (unsigned int a = 0; a < n_jumps; ++a)
        jump_rhs_[3 * jump_site(point, a) + l] += rhs(3 * a + l);
      for (unsigned int a = 0; a < sum.n_nodes; ++a)
        law_rhs_[3 * point.slaves[a] + l] += rhs(sum.first_node + 3 * a + l);
    }

    // B A B^T with the rows of B from find_unknowns(): entries of one place are added up here, for the sites of a face
    // have most of their nodes in common.
    find_unknowns(point, sum);
    const unsigned int m = rows_.size();
    half_.assign(m * n, 0.);
    product_.assign(m * m, 0.);
    Eigen::Map<Eigen::MatrixXd> half(half_.data(), m, n), product(product_.data(), m, m);
    for (unsigned int l = 0; l < n; ++l)
      for (const Unknown &u : unknowns_)
        half(u.row, l) += u.of(A.col(l).data());
    for (const Unknown &v : unknowns_)
      for (unsigned int i = 0; i < v.n; ++i)
        product.col(v.row) += v.part[i] * half.col(v.first + i);
    for (unsigned int j = 0; j < m; ++j)
      for (unsigned int i = 0; i < m; ++i)
        if (const double value = product(i, j); value != 0.)
          add_entry(system.contact, rows_[i], rows_[j], value, system);
  }

  void ContactScatter::add_variation(const ContactPoint              &point,
                                     const LawSum                    &sum,
                                     const std::vector<unsigned int> &slaves,
                                     const Eigen::MatrixXd           &derivative,
                                     LinearSystem                    &system) const
  {
    find_unknowns(point, sum);
    for (unsigned int k = 0; k < slaves.size(); ++k)
    {
      const DoFIndex lambda = surfaces_.layout().lambda(surfaces_.multiplier(slaves[k]));
      half_.assign(rows_.size(), 0.);
      for (const Unknown &u : unknowns_)
        half_[u.row] += u.of(derivative.col(k).data());
      for (unsigned int i = 0; i < rows_.size(); ++i)
        if (half_[i] != 0.)
          add_entry(system.variation, rows_[i], lambda, half_[i], system);
    }
  }

  void ContactScatter::add_distance_variation(const ContactPoint &point,
                                              const LawSum       &sum,
                                              const double        slope,
                                              LinearSystem       &system) const
  {
    if (slope == 0.)
      return;
    LocalVector normal = LocalVector::Zero(sum.n_unknowns());
    for (unsigned int c = 0; c < dim; ++c)
      normal(c) = slope * pairing_[point.site].normal[c];
    find_unknowns(point, sum);
    half_.assign(rows_.size(), 0.);
    product_.assign(rows_.size(), 0.);
    for (const Unknown &u : unknowns_)
    {
      half_[u.row] += u.of(sum.by_threshold.data());
      product_[u.row] += u.of(normal.data());
    }
    for (unsigned int i = 0; i < rows_.size(); ++i)
      for (unsigned int j = 0; j < rows_.size(); ++j)
        if (const double value = half_[i] * product_[j]; value != 0.)
          add_entry(system.variation, rows_[i], rows_[j], value, system);
  }

  void ContactScatter::add_resultant(std::vector<double> &sum, const RigidShare &share, const Vector3 &force)
  {
    for (unsigned int c = 0; c < 2 * dim; ++c)
      sum[2 * dim * share.body + c] += share.jump[c] * force;
  }

  void ContactScatter::fill_rhs(LinearSystem &system)
  {
    surfaces_.slave_exchange().sum(law_rhs_, 3);
    const OwnedValues normal(system.rhs.block(1)), tangential(system.rhs.block(2));
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
    {
      const DoFIndex multiplier = surfaces_.multiplier(k);
      normal(multiplier)        = law_rhs_[3 * k];
      for (unsigned int i = 0; i < 2; ++i)
        tangential(2 * multiplier + i) = law_rhs_[3 * k + 1 + i];
    }
    std::vector<Vector3> forces(surfaces_.nodes().size());
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
    {
      const Vector3 rhs({jump_rhs_[3 * s], jump_rhs_[3 * s + 1], jump_rhs_[3 * s + 2]});
      for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
      {
        const Vector3 force = jump_.force(s, *e, rhs);
        for (unsigned int c = 0; c < dim; ++c)
          if (!surfaces_.fixed(e->node, c))
            forces[e->node][c] += force[c];
      }
    }
    surfaces_.add(forces, system.rhs.block(0));
    system.border_rhs.assign(2 * dim * surfaces_.layout().n_rigid, 0.);
    for (const RigidShare &share : shares_)
    {
      const double *const rhs = jump_rhs_.data() + 3 * share.site;
      add_resultant(system.border_rhs, share, Vector3({rhs[0], rhs[1], rhs[2]}));
    }
  }

  ContactResidual ContactScatter::finish()
  {
    const BlockLayout &layout = surfaces_.layout();
    wait_for_all(layout.communicator);
    surfaces_.site_exchange().sum(jump_residual_, 3);
    surfaces_.slave_exchange().sum(law_residual_, 4);
    ContactResidual result;
    result.jump.resize(surfaces_.n_sites());
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      for (unsigned int c = 0; c < dim; ++c)
        result.jump[s][c] = jump_residual_[3 * s + c];
    result.rigid.assign(2 * dim * layout.n_rigid, 0.);
    for (const RigidShare &share : shares_)
      if (surfaces_.is_owned(share.site))
        add_resultant(result.rigid, share, result.jump[share.site]);
    for (unsigned int k = 0; k < surfaces_.slave_nodes().size(); ++k)
    {
      const double *const row = law_residual_.data() + 4 * k;
      result.lambda.push_back(row[0]);
      result.Lambda.push_back({{row[1], row[2]}});
      result.friction_weight.push_back(row[3]);
    }
    return result;
  }

  void ContactScatter::add_turns(const ContactResidual &residual, LinearSystem &system) const
  {
    for (const RigidShare &share : shares_)
      if (surfaces_.is_owned(share.site) && share.arm != Vector3())
        add_turn(surfaces_.layout(), share.body, share.arm, residual.jump[share.site], system.border);
  }
} // namespace Nodus
