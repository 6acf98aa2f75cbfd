#include "contact/contact_assembler.h"
#include "parallel/owned_values.h"
#include "parallel/wait_for_all.h"

#include <deal.II/base/mpi.h>

#include <Eigen/Dense>

namespace Nodus
{
  namespace
  {
    using Matrix3 = Eigen::Matrix3d;
    using Column3 = Eigen::Vector3d;
    using Rows23  = Eigen::Matrix<double, 2, 3>;

    constexpr double on_the_sphere = 1e-7; ///< see direction()

    Column3 eigen(const Vector3 &v)
    {
      return {v[0], v[1], v[2]};
    }

    /// A slave node at a contact point: shape times filter for each filtered multiplier field.
    struct PointNode
    {
      unsigned int slave;
      double       contact, stick, slip; ///< phi S, phi S S_f, phi S (1 - S_f); the last two 0 where frictionless
      double       open;                 ///< phi (1 - S)
      double  void_tangent[2]; ///< phi where Lambda_i has no friction to carry: open, frictionless or void direction
      Rows23  tangent;         ///< rows: free tangents, zero where void
      Column3 axis[2];         ///< both tangents
    };

    /// A jump at a contact point, filtered alike; one a slave node, or one for the point.
    struct PointJump
    {
      unsigned int site;
      double       contact, stick, slip;
      Column3      normal;
      Matrix3      projector; ///< on the free tangents, times the friction scale of each
    };

    /// pi(w) = w/|w| and its derivative K_B (eq. 48). Inside the unit ball a slip node contradicts its status; there
    /// the projection pi(w) = w takes over (K_B = I, the stick rows), because forced slip may have no solution. A node
    /// that goes on slipping starts the increment with |w| = 1 up to round-off and the tolerance of Newton: on the
    /// sphere.
    void direction(const Column3 &w, Column3 &pi, Matrix3 &K_B)
    {
      const double norm = w.norm();
      if (norm < 1. - on_the_sphere)
      {
        pi  = w;
        K_B = Matrix3::Identity();
        return;
      }
      pi  = w / norm;
      K_B = (Matrix3::Identity() - pi * pi.transpose()) / norm;
    }

    /// Unknowns of a point: three components of each jump, then lambda and two Lambda of each node.
    constexpr int max_local = 9 * 6;
    using LocalMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_local, max_local>;
    using LocalVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_local, 1>;
  } // namespace

  ContactAssembler::ContactAssembler(const ContactSurfaces &surfaces,
                                     const Pairing         &pairing,
                                     const JumpOperator    &jump,
                                     const SurfaceWeights  &weights,
                                     const Status          &status)
      : surfaces_(surfaces)
      , pairing_(pairing)
      , jump_(jump)
      , weights_(weights)
      , status_(status)
  {
  }

  double ContactAssembler::distance(const ContactState &state, const unsigned int site) const
  {
    return pairing_[site].normal * jump_.jump(site, state.x) - status_.adjustment(site);
  }

  std::array<double, 2> ContactAssembler::slip(const ContactState &state, const unsigned int site) const
  {
    std::array<double, 2> result{{0., 0.}};
    const Vector3         jump = jump_.jump_of_increment(site, state.increment);
    for (unsigned int i = 0; i < 2; ++i)
      if (pairing_[site].tangent_free[i])
        result[i] = pairing_[site].tangent[i] * jump;
    return result;
  }

  std::vector<std::vector<std::pair<unsigned int, double>>> ContactAssembler::threshold_derivative() const
  {
    // lambda_bar of slave nodes is (M S lambda)_j / m_j, lambda of integration points the interpolated one.
    std::vector<std::vector<std::pair<unsigned int, double>>> derivative(surfaces_.n_sites());
    const auto add = [&](const unsigned int site, const unsigned int k, const double weight)
    {
      const double value = status_.threshold_slope(site) * weight;
      for (auto &[slave, sum] : derivative[site])
        if (slave == k)
        {
          sum += value;
          return;
        }
      derivative[site].emplace_back(k, value);
    };
    for (const ContactPoint &point : weights_.points())
      for (unsigned int b = 0; b < point.slaves.size(); ++b)
        if (point.site != dealii::numbers::invalid_unsigned_int)
        {
          if (status_.friction(point.site))
            add(point.site, point.slaves[b], point.shape[b]);
        }
        else if (status_.contact(point.slaves[b]))
          for (unsigned int a = 0; a < point.slaves.size(); ++a)
            if (const unsigned int k = point.slaves[a]; status_.friction(k))
              add(k, point.slaves[b], point.weight * point.shape[a] * point.shape[b] / weights_.area()[k]);
    return derivative;
  }

  std::vector<ContactAssembler::RigidShare> ContactAssembler::rigid_shares(const ContactState &state) const
  {
    std::vector<RigidShare> shares(surfaces_.layout().n_rigid > 0 ? surfaces_.n_sites() : 0);
    for (unsigned int s = 0; s < shares.size(); ++s)
      for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
        if (const unsigned int body = surfaces_.rigid_body(e->node); body != dealii::numbers::invalid_unsigned_int)
        {
          shares[s].body = body; // slave and master are not both rigid
          shares[s].weight += e->weight;
          shares[s].arm += e->weight * (state.x[e->node] - state.centre[body]);
        }
    return shares;
  }

  ContactResidual
  ContactAssembler::assemble(const ContactState &state, LinearSystem &system, const bool linearise_threshold) const
  {
    const BlockLayout &layout  = surfaces_.layout();
    const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(layout.communicator);
    const unsigned int n       = surfaces_.slave_nodes().size();
    const unsigned int n_sites = surfaces_.n_sites();
    system.contact.clear();
    system.variation.clear();
    system.border.clear();
    system.border_rhs.assign(2 * dim * layout.n_rigid, 0.);
    const std::vector<RigidShare> shares      = rigid_shares(state);
    const bool                    unsymmetric = linearise_threshold && status_.threshold_follows_pressure();
    system.symmetric                          = !unsymmetric;
    const auto d_threshold =
        unsymmetric ? threshold_derivative() : std::vector<std::vector<std::pair<unsigned int, double>>>();

    // Residual and right-hand side: three components of each jump; lambda, two Lambda and the friction weight of each
    // slave node. The points of this rank add to ghosts, too.
    std::vector<double> jump_residual(3 * n_sites, 0.), jump_rhs(3 * n_sites, 0.);
    std::vector<double> law_residual(4 * n, 0.), law_rhs(3 * n, 0.);

    std::vector<PointNode> nodes;
    std::vector<PointJump> jumps;
    LocalMatrix            A;
    LocalVector            r, b, r_t; // r_t: derivative of r with respect to the threshold at the point
    // Slave nodes whose pressures the thresholds of a face follow, their numbers there, the threshold's derivative at a
    // point, and that of r.
    std::vector<unsigned int> followed, number(unsymmetric ? n : 0, dealii::numbers::invalid_unsigned_int);
    Eigen::VectorXd           point_derivative;
    Eigen::MatrixXd           V;
    const auto               &points = weights_.points();
    for (auto begin = points.begin(), end = begin; begin != points.end(); begin = end)
    {
      // The points of a face have the same unknowns and are summed before their jumps are expanded; a point with a site
      // of its own has its own jump.
      const bool pointwise = begin->site != dealii::numbers::invalid_unsigned_int;
      do
        ++end;
      while (!pointwise && end != points.end() && end->site == begin->site && end->slaves == begin->slaves);
      if (begin->owner != rank)
        continue;
      const unsigned int n_nodes = begin->slaves.size(), n_jumps = pointwise ? 1 : n_nodes, first = 3 * n_jumps;
      const unsigned int n_unknowns = first + 3 * n_nodes;
      nodes.resize(n_nodes);
      jumps.resize(n_jumps);
      A.setZero(n_unknowns, n_unknowns);
      r.setZero(n_unknowns);
      b.setZero(n_unknowns);
      followed.clear();
      for (unsigned int a = 0; a < n_jumps && unsymmetric; ++a)
        for (const auto &[k, derivative] : d_threshold[pointwise ? begin->site : begin->slaves[a]])
          if (number[k] == dealii::numbers::invalid_unsigned_int)
          {
            number[k] = followed.size();
            followed.push_back(k);
          }
      V.setZero(n_unknowns, followed.size());
      for (auto p = begin; p != end; ++p)
      {
        const ContactPoint &point = *p;
        // Filtered fields at the point.
        double  lambda_c = 0, lambda_o = 0, distance = 0, threshold = 0;
        Column3 Lambda_stick = Column3::Zero(), slip_stick = Column3::Zero(), Lambda_slip = Column3::Zero(),
                slip_slip      = Column3::Zero();
        Column3 Lambda_void[2] = {Column3::Zero(), Column3::Zero()};
        bool    slips          = false;
        for (unsigned int a = 0; a < n_nodes; ++a)
        {
          PointNode         &node    = nodes[a];
          const unsigned int k       = point.slaves[a];
          const unsigned int filter  = pointwise ? point.site : k;
          const double       phi     = point.shape[a];
          const SitePairing &pairing = pairing_[k];
          const bool         contact = status_.contact(filter), friction = status_.friction(filter);
          node.slave       = k;
          node.contact     = contact ? phi : 0.;
          node.open        = contact ? 0. : phi;
          const bool stick = status_.stick(filter) && !status_.projected(filter);
          node.stick       = friction && stick ? phi : 0.;
          node.slip        = friction && !stick ? phi : 0.;
          for (unsigned int i = 0; i < 2; ++i)
          {
            const bool carries   = friction && pairing.tangent_free[i];
            node.void_tangent[i] = carries ? 0. : phi;
            node.axis[i]         = eigen(pairing.tangent[i]);
            node.tangent.row(i) =
                pairing.tangent_free[i] ? node.axis[i].transpose().eval() : Column3::Zero().transpose().eval();
            Lambda_void[i] += node.void_tangent[i] * state.Lambda[k][i] * node.axis[i];
          }
          const Column3 Lambda = node.tangent.transpose() * Eigen::Vector2d(state.Lambda[k][0], state.Lambda[k][1]);
          lambda_c += node.contact * state.lambda[k];
          lambda_o += node.open * state.lambda[k];
          Lambda_stick += node.stick * Lambda;
          Lambda_slip += node.slip * Lambda;
          slips = slips || node.slip != 0.;
        }
        for (unsigned int a = 0; a < n_jumps; ++a)
        {
          PointJump         &jump     = jumps[a];
          const unsigned int s        = pointwise ? point.site : point.slaves[a];
          const double       phi      = pointwise ? 1. : point.shape[a];
          const bool         friction = status_.friction(s);
          jump.site                   = s;
          jump.contact                = status_.contact(s) ? phi : 0.;
          const bool stick            = status_.stick(s) && !status_.projected(s);
          jump.stick                  = friction && stick ? phi : 0.;
          jump.slip                   = friction && !stick ? phi : 0.;
          jump.normal                 = eigen(pairing_[s].normal);
          jump.projector.setZero();
          for (unsigned int i = 0; i < 2; ++i)
            if (pairing_[s].tangent_free[i])
            {
              const Column3 t = eigen(pairing_[s].tangent[i]);
              jump.projector += pairing_[s].friction_scale[i] * t * t.transpose();
            }
          const Column3 slip = jump.projector * eigen(jump_.jump_of_increment(s, state.increment));
          distance += jump.contact * this->distance(state, s);
          threshold += phi * (friction ? status_.threshold(s) : 0.);
          slip_stick += jump.stick * slip;
          slip_slip += jump.slip * slip;
        }
        const double h_n = status_.normal_augmentation(point.slaves[0]);
        // the normal law of a point is projected, too: its pressure is lambda - h_n d_n where that is negative
        const double stiffness = pointwise && status_.projected(point.site) ? h_n : 0.;
        const double h_tau     = status_.tangential_augmentation(point.slaves[0], threshold);
        Column3      pi        = Column3::Zero();
        Matrix3      K_B       = Matrix3::Zero();
        const bool   held      = status_.holds_friction(pointwise ? point.site : point.slaves[0]);
        if (slips && held) // Lambda stays as it is
          pi = Lambda_slip;
        else if (slips)
          direction(Lambda_slip + h_tau * slip_slip, pi, K_B);

        r_t.setZero(n_unknowns);
        const double  W = point.weight, Wt = point.weight * threshold;
        const Column3 pi_t = slips ? Column3(K_B * slip_slip * (h_tau / -threshold)) : pi; // h_tau ~ 1/threshold
        for (unsigned int a = 0; a < n_jumps; ++a)
        {
          const PointJump &i  = jumps[a];
          const unsigned   ia = 3 * a;
          r.segment<3>(ia) += -W * i.contact * (lambda_c - stiffness * distance) * i.normal -
                              Wt * i.stick * i.projector * Lambda_stick - Wt * i.slip * i.projector * pi;
          r_t.segment<3>(ia) = -W * i.projector * ((n_nodes > 1 ? i.stick : 0.) * Lambda_stick + i.slip * pi) -
                               Wt * i.slip * i.projector * pi_t;
          b.segment<3>(ia) = eigen(jump_.jump(i.site, state.prescribed));
          Assert(i.contact == 0. || jump_.begin(i.site) != jump_.end(i.site),
                 dealii::ExcMessage("the partner of a site in contact is not on this rank"));

          for (unsigned int c = 0; c < n_nodes; ++c)
          {
            const PointNode &j  = nodes[c];
            const unsigned   jc = first + 3 * c;
            A.block<3, 1>(ia, jc) -= W * i.contact * j.contact * i.normal;
            A.block<3, 2>(ia, jc + 1) -= Wt * i.stick * j.stick * i.projector * j.tangent.transpose();
            if (slips)
              A.block<3, 2>(ia, jc + 1) -= Wt * i.slip * j.slip * i.projector * K_B * j.tangent.transpose();
          }
          if (stiffness > 0. && i.contact != 0.)
            A.block<3, 3>(ia, ia) += W * stiffness * i.normal * i.normal.transpose();
          if (slips)
            for (unsigned int c = 0; c < n_jumps; ++c)
              A.block<3, 3>(ia, 3 * c) += -Wt * h_tau * i.slip * jumps[c].slip * i.projector * K_B * jumps[c].projector;
        }
        for (unsigned int a = 0; a < n_nodes; ++a)
        {
          const PointNode &i  = nodes[a];
          const unsigned   ia = first + 3 * a;
          law_residual[4 * i.slave + 3] -= std::abs(i.stick + i.slip) * Wt;
          r(ia) += -W * i.open * lambda_o / h_n - W * i.contact * distance;
          r.segment<2>(ia + 1) +=
              -Wt * i.stick * i.tangent * slip_stick + (Wt / h_tau) * i.slip * i.tangent * (Lambda_slip - pi);
          r_t.segment<2>(ia + 1) = -(Wt / h_tau) * i.slip * i.tangent * pi_t;
          if (n_nodes > 1)
            r_t.segment<2>(ia + 1) +=
                -W * i.stick * i.tangent * slip_stick + (2. * W / h_tau) * i.slip * i.tangent * (Lambda_slip - pi);
          for (unsigned int t = 0; t < 2 && !held; ++t)
            r(ia + 1 + t) -= W * i.void_tangent[t] * Lambda_void[t].dot(i.axis[t]);
          for (unsigned int c = 0; c < n_nodes; ++c)
          {
            const PointNode &j  = nodes[c];
            const unsigned   jc = first + 3 * c;
            A(ia, jc) -= W / h_n * i.open * j.open;
            if (slips)
              A.block<2, 2>(ia + 1, jc + 1) +=
                  Wt / h_tau * i.slip * j.slip * i.tangent * (Matrix3::Identity() - K_B) * j.tangent.transpose();
            for (unsigned int t = 0; t < 2; ++t)
              A(ia + 1 + t, jc + 1 + t) -= W * i.void_tangent[t] * j.void_tangent[t] * i.axis[t].dot(j.axis[t]);
          }
        }

        if (unsymmetric)
        {
          point_derivative.setZero(followed.size());
          for (const PointJump &jump : jumps)
            if (jump.slip != 0. || (jump.stick != 0. && n_nodes > 1))
              for (const auto &[k, derivative] : d_threshold[jump.site])
                point_derivative(number[k]) += jump.contact * derivative;
          V += r_t * point_derivative.transpose();
        }
      }
      A.block(first, 0, 3 * n_nodes, first) = A.block(0, first, first, 3 * n_nodes).transpose();

      const LocalVector local_rhs = -(r + A * b);
      for (unsigned int l = 0; l < 3; ++l)
      {
        for (unsigned int a = 0; a < n_jumps; ++a)
        {
          jump_residual[3 * jumps[a].site + l] += r(3 * a + l);
          jump_rhs[3 * jumps[a].site + l] += local_rhs(3 * a + l);
        }
        for (unsigned int a = 0; a < n_nodes; ++a)
        {
          law_residual[4 * nodes[a].slave + l] += r(first + 3 * a + l);
          law_rhs[3 * nodes[a].slave + l] += local_rhs(first + 3 * a + l);
        }
      }

      // Expand the jumps to displacements, free components only: rows and columns of prescribed ones drop out. Driven
      // rigid bodies stand in the border.
      const auto for_each_unknown = [&](const unsigned int local, const auto &f)
      {
        if (local >= first)
        {
          const DoFIndex     k = surfaces_.multiplier(nodes[(local - first) / 3].slave);
          const unsigned int l = (local - first) % 3;
          f(l == 0 ? layout.lambda(k) : layout.Lambda(k, l - 1), 1.);
          return;
        }
        const unsigned int s = jumps[local / 3].site, l = local % 3;
        for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
          if (!surfaces_.fixed(e->node, l))
            f(surfaces_.nodes()[e->node].dofs[l], e->weight);
        if (!shares.empty() && shares[s].weight != 0.)
          surfaces_.for_each_rigid_unknown(shares[s].body, l, shares[s].weight, shares[s].arm, f);
      };
      const auto add = [&](TripletMatrix &inner, const DoFIndex row, const DoFIndex column, const double value)
      { (row < layout.size() && column < layout.size() ? inner : system.border).add(row, column, value); };
      for (unsigned int i = 0; i < n_unknowns; ++i)
        for (unsigned int j = 0; j < n_unknowns; ++j)
          if (A(i, j) != 0.)
            for_each_unknown(i,
                             [&](const DoFIndex row, const double row_weight)
                             {
                               for_each_unknown(
                                   j,
                                   [&](const DoFIndex column, const double column_weight)
                                   { add(system.contact, row, column, row_weight * column_weight * A(i, j)); });
                             });
      for (unsigned int m = 0; m < followed.size(); ++m)
      {
        number[followed[m]]   = dealii::numbers::invalid_unsigned_int;
        const DoFIndex lambda = layout.lambda(surfaces_.multiplier(followed[m]));
        for (unsigned int i = 0; i < n_unknowns; ++i)
          if (V(i, m) != 0.)
            for_each_unknown(i,
                             [&](const DoFIndex row, const double weight)
                             { add(system.variation, row, lambda, weight * V(i, m)); });
      }
    }

    wait_for_all(layout.communicator);
    surfaces_.slave_exchange().sum(law_rhs, 3);
    const OwnedValues normal(system.rhs.block(1)), tangential(system.rhs.block(2));
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
    {
      const DoFIndex multiplier = surfaces_.multiplier(k);
      normal(multiplier)        = law_rhs[3 * k];
      for (unsigned int i = 0; i < 2; ++i)
        tangential(2 * multiplier + i) = law_rhs[3 * k + 1 + i];
    }
    std::vector<Vector3> forces(surfaces_.nodes().size());
    for (unsigned int s = 0; s < n_sites; ++s)
      for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
        for (unsigned int c = 0; c < dim; ++c)
          if (!surfaces_.fixed(e->node, c))
            forces[e->node][c] += e->weight * jump_rhs[3 * s + c];
    surfaces_.add(forces, system.rhs.block(0));
    const auto add_resultant = [&](std::vector<double> &sum, const RigidShare &share, const Vector3 &force)
    {
      const Vector3 moment = dealii::cross_product_3d(share.arm, force);
      for (unsigned int c = 0; c < dim && share.weight != 0.; ++c)
      {
        sum[2 * dim * share.body + c] += share.weight * force[c];
        sum[2 * dim * share.body + dim + c] += moment[c];
      }
    };
    for (unsigned int s = 0; s < shares.size(); ++s)
      add_resultant(system.border_rhs, shares[s], Vector3({jump_rhs[3 * s], jump_rhs[3 * s + 1], jump_rhs[3 * s + 2]}));

    surfaces_.site_exchange().sum(jump_residual, 3);
    surfaces_.slave_exchange().sum(law_residual, 4);
    ContactResidual result;
    result.jump.resize(n_sites);
    for (unsigned int s = 0; s < n_sites; ++s)
      for (unsigned int c = 0; c < dim; ++c)
        result.jump[s][c] = jump_residual[3 * s + c];
    result.rigid.assign(2 * dim * layout.n_rigid, 0.);
    for (unsigned int s = 0; s < shares.size(); ++s)
      if (surfaces_.is_owned(s) && shares[s].weight != 0.)
      {
        add_resultant(result.rigid, shares[s], result.jump[s]);
        add_turn(layout, shares[s].body, shares[s].arm, result.jump[s], system.border);
      }
    for (unsigned int k = 0; k < n; ++k)
    {
      const double *const row = law_residual.data() + 4 * k;
      result.lambda.push_back(row[0]);
      result.Lambda.push_back({{row[1], row[2]}});
      result.friction_weight.push_back(row[3]);
    }

    system.multiplier_scale.assign(3 * surfaces_.n_owned_slave_nodes(), 1.);
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
      if (result.friction_weight[k] > 0.)
        for (unsigned int i = 1; i < 3; ++i)
          system.multiplier_scale[3 * k + i] = weights_.area()[k] / result.friction_weight[k];
    return result;
  }

  void ContactAssembler::add_forces(const ContactResidual &residual, Vector &force) const
  {
    std::vector<Vector3> forces(surfaces_.nodes().size());
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      if (surfaces_.is_owned(s))
        for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
          forces[e->node] += e->weight * residual.jump[s];
    surfaces_.add(forces, force);
  }

  double ContactAssembler::norm(const ContactResidual &residual, const double length) const
  {
    double norm = 0.;
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
    {
      const double area = weights_.area()[k];
      norm              = std::max(norm, std::abs(residual.lambda[k]) / (area * length));
      double scale      = area; // open or frictionless: the row is -m Lambda
      if (residual.friction_weight[k] > 0.)
      {
        const double threshold = residual.friction_weight[k] / area;
        const bool   slips     = surfaces_.has_status(k) && (!status_.stick(k) || status_.projected(k));
        scale = area * threshold * (slips ? 1. / status_.tangential_augmentation(k, -threshold) : length);
      }
      norm = std::max(norm, std::hypot(residual.Lambda[k][0], residual.Lambda[k][1]) / scale);
    }
    return dealii::Utilities::MPI::max(norm, surfaces_.layout().communicator);
  }
} // namespace Nodus
