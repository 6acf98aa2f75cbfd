#include <nodus/contact/contact_assembler.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Dense>

namespace Nodus
{
  namespace
  {
    using Matrix3 = Eigen::Matrix3d;
    using Column3 = Eigen::Vector3d;
    using Rows23  = Eigen::Matrix<double, 2, 3>;

    Column3 eigen(const Vector3 &v)
    {
      return {v[0], v[1], v[2]};
    }

    /// A slave node at a contact point: shape times filter for each filtered field.
    struct PointNode
    {
      unsigned int slave;
      double       contact, stick, slip; ///< phi S, phi S S_f, phi S (1 - S_f); the last two 0 where frictionless
      double       open;                 ///< phi (1 - S)
      double  void_tangent[2]; ///< phi where Lambda_i has no friction to carry: open, frictionless or void direction
      Column3 normal;
      Rows23  tangent; ///< rows: free tangents, zero where void
      Column3 increment;
      double  distance;
    };

    /// pi(w) = w/|w| and its derivative K_B (eq. 48). Inside the unit ball a slip node contradicts its status; there the
    /// projection pi(w) = w takes over (K_B = I, the stick rows), because forced slip may have no solution.
    void direction(const Column3 &w, Column3 &pi, Matrix3 &K_B)
    {
      const double norm = w.norm();
      if (norm < 1.)
      {
        pi  = w;
        K_B = Matrix3::Identity();
        return;
      }
      pi  = w / norm;
      K_B = (Matrix3::Identity() - pi * pi.transpose()) / norm;
    }

    /// Unknowns of a point: three jump components, lambda, two Lambda per node.
    constexpr unsigned int n_local   = 6;
    constexpr int          max_local = 9 * n_local;
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

  double ContactAssembler::distance(const ContactState &state, const unsigned int slave) const
  {
    return pairing_[slave].normal * jump_.jump(slave, state.x);
  }

  std::array<double, 2> ContactAssembler::slip(const ContactState &state, const unsigned int slave) const
  {
    std::array<double, 2> result{{0., 0.}};
    const Vector3         jump = jump_.jump(slave, state.increment);
    for (unsigned int i = 0; i < 2; ++i)
      if (pairing_[slave].tangent_free[i])
        result[i] = pairing_[slave].tangent[i] * jump;
    return result;
  }

  ContactResidual ContactAssembler::assemble(const ContactState &state, LinearSystem &system) const
  {
    const BlockLayout &layout = surfaces_.layout();
    const unsigned int rank   = dealii::Utilities::MPI::this_mpi_process(layout.communicator);
    const unsigned int n      = layout.n_slave_nodes;
    system.contact.clear();

    // Residual and right-hand side per slave node: jump (3), lambda, Lambda (2).
    std::vector<double> residual(n_local * n, 0.), rhs(n_local * n, 0.);

    std::vector<PointNode> nodes;
    LocalMatrix            A;
    LocalVector            r, b;
    for (const ContactPoint &point : weights_.points())
    {
      if (point.owner != rank)
        continue;
      const unsigned int n_nodes = point.slaves.size();

      // Filtered fields at the point.
      nodes.resize(n_nodes);
      double  lambda_c = 0, lambda_o = 0, distance = 0, threshold = 0;
      Column3 Lambda_stick = Column3::Zero(), slip_stick = Column3::Zero(), Lambda_slip = Column3::Zero(),
              slip_slip      = Column3::Zero();
      Column3 Lambda_void[2] = {Column3::Zero(), Column3::Zero()};
      bool    slips          = false;
      for (unsigned int a = 0; a < n_nodes; ++a)
      {
        PointNode         &node    = nodes[a];
        const unsigned int k       = point.slaves[a];
        const double       phi     = point.shape[a];
        const NodePairing &pairing = pairing_[k];
        const bool         contact = status_.contact(k), friction = status_.friction(k);
        node.slave     = k;
        node.contact   = contact ? phi : 0.;
        node.open      = contact ? 0. : phi;
        node.stick     = friction && status_.stick(k) ? phi : 0.;
        node.slip      = friction && !status_.stick(k) ? phi : 0.;
        node.normal    = eigen(pairing.normal);
        node.increment = eigen(jump_.jump(k, state.increment));
        node.distance  = this->distance(state, k);
        for (unsigned int i = 0; i < 2; ++i)
        {
          const bool carries   = friction && pairing.tangent_free[i];
          node.void_tangent[i] = carries ? 0. : phi;
          node.tangent.row(i)  = pairing.tangent_free[i] ? eigen(pairing.tangent[i]).transpose().eval()
                                                         : Column3::Zero().transpose().eval();
          Lambda_void[i] += node.void_tangent[i] * state.Lambda[k][i] * eigen(pairing.tangent[i]);
        }
        const Column3 Lambda = node.tangent.transpose() * Eigen::Vector2d(state.Lambda[k][0], state.Lambda[k][1]);
        const Column3 slip   = node.tangent.transpose() * (node.tangent * node.increment);
        lambda_c += node.contact * state.lambda[k];
        lambda_o += node.open * state.lambda[k];
        distance += node.contact * node.distance;
        threshold += phi * (friction ? status_.threshold(k) : 0.);
        Lambda_stick += node.stick * Lambda;
        slip_stick += node.stick * slip;
        Lambda_slip += node.slip * Lambda;
        slip_slip += node.slip * slip;
        slips = slips || node.slip != 0.;
      }
      const double h_n   = status_.normal_augmentation(point.slaves[0]);
      const double h_tau = status_.tangential_augmentation(point.slaves[0], threshold);
      Column3      pi    = Column3::Zero();
      Matrix3      K_B   = Matrix3::Zero();
      if (slips)
        direction(Lambda_slip + h_tau * slip_slip, pi, K_B);

      A.setZero(n_local * n_nodes, n_local * n_nodes);
      r.setZero(n_local * n_nodes);
      b.setZero(n_local * n_nodes);
      const double W = point.weight, Wt = point.weight * threshold;
      for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const PointNode &i  = nodes[a];
        const unsigned   ia = n_local * a;
        const Matrix3    Pi = i.tangent.transpose() * i.tangent;

        r.segment<3>(ia) =
            -W * i.contact * lambda_c * i.normal - Wt * i.stick * Pi * Lambda_stick - Wt * i.slip * Pi * pi;
        r(ia + 3) = -W * i.open * lambda_o / h_n - W * i.contact * distance;
        r.segment<2>(ia + 4) =
            -Wt * i.stick * i.tangent * slip_stick + (Wt / h_tau) * i.slip * i.tangent * (Lambda_slip - pi);
        for (unsigned int t = 0; t < 2; ++t)
          r(ia + 4 + t) -= W * i.void_tangent[t] * Lambda_void[t].dot(eigen(pairing_[i.slave].tangent[t]));
        b.segment<3>(ia) = eigen(jump_.jump(i.slave, state.prescribed));

        for (unsigned int c = 0; c < n_nodes; ++c)
        {
          const PointNode &j  = nodes[c];
          const unsigned   jc = n_local * c;
          const Matrix3    Pj = j.tangent.transpose() * j.tangent;

          A.block<3, 1>(ia, jc + 3) = -W * i.contact * j.contact * i.normal;
          A.block<1, 3>(ia + 3, jc) = -W * i.contact * j.contact * j.normal.transpose();
          A(ia + 3, jc + 3)         = -W / h_n * i.open * j.open;

          A.block<3, 2>(ia, jc + 4) = -Wt * i.stick * j.stick * Pi * j.tangent.transpose();
          A.block<2, 3>(ia + 4, jc) = -Wt * i.stick * j.stick * i.tangent * Pj;
          if (slips)
          {
            A.block<3, 3>(ia, jc) -= Wt * h_tau * i.slip * j.slip * Pi * K_B * Pj;
            A.block<3, 2>(ia, jc + 4) -= Wt * i.slip * j.slip * Pi * K_B * j.tangent.transpose();
            A.block<2, 3>(ia + 4, jc) -= Wt * i.slip * j.slip * i.tangent * K_B * Pj;
            A.block<2, 2>(ia + 4, jc + 4) +=
                Wt / h_tau * i.slip * j.slip * i.tangent * (Matrix3::Identity() - K_B) * j.tangent.transpose();
          }
          for (unsigned int t = 0; t < 2; ++t)
            A(ia + 4 + t, jc + 4 + t) -= W * i.void_tangent[t] * j.void_tangent[t] *
                                         (pairing_[i.slave].tangent[t] * pairing_[j.slave].tangent[t]);
        }
      }

      const LocalVector local_rhs = -(r + A * b);
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int l = 0; l < n_local; ++l)
        {
          residual[n_local * point.slaves[a] + l] += r(n_local * a + l);
          rhs[n_local * point.slaves[a] + l] += local_rhs(n_local * a + l);
        }

      // Expand the jump to displacements, free components only: rows and columns of prescribed ones drop out.
      const auto for_each_unknown = [&](const unsigned int local, const auto &f)
      {
        const unsigned int k = point.slaves[local / n_local], l = local % n_local;
        if (l == 3)
          f(layout.lambda(k), 1.);
        else if (l > 3)
          f(layout.Lambda(k, l - 4), 1.);
        else
          for (auto e = jump_.begin(k); e != jump_.end(k); ++e)
            if (!surfaces_.fixed(e->node, l))
              f(surfaces_.nodes()[e->node].dofs[l], e->weight);
      };
      for (unsigned int i = 0; i < n_local * n_nodes; ++i)
        for (unsigned int j = 0; j < n_local * n_nodes; ++j)
          if (A(i, j) != 0.)
            for_each_unknown(i,
                             [&](const DoFIndex row, const double row_weight)
                             {
                               for_each_unknown(j,
                                                [&](const DoFIndex column, const double column_weight) {
                                                  system.contact.add(row, column, row_weight * column_weight * A(i, j));
                                                });
                             });
    }

    dealii::Utilities::MPI::sum(residual, layout.communicator, residual);
    dealii::Utilities::MPI::sum(rhs, layout.communicator, rhs);

    const auto owned = surfaces_.owned_slave_nodes();
    system.multiplier_scale.assign(3 * (owned.second - owned.first), 1.);
    for (unsigned int k = owned.first; k < owned.second; ++k)
    {
      system.rhs.block(1)(k) = rhs[n_local * k + 3];
      for (unsigned int i = 0; i < 2; ++i)
      {
        system.rhs.block(2)(2 * k + i) = rhs[n_local * k + 4 + i];
        if (status_.friction(k))
          system.multiplier_scale[3 * (k - owned.first) + 1 + i] = -1. / status_.threshold(k);
      }
      for (auto e = jump_.begin(k); e != jump_.end(k); ++e)
        for (unsigned int c = 0; c < dim; ++c)
          if (!surfaces_.fixed(e->node, c))
            system.rhs.block(0)(surfaces_.nodes()[e->node].dofs[c]) += e->weight * rhs[n_local * k + c];
    }
    system.rhs.block(0).compress(dealii::VectorOperation::add);
    system.rhs.block(1).compress(dealii::VectorOperation::insert);
    system.rhs.block(2).compress(dealii::VectorOperation::insert);

    ContactResidual result;
    result.jump.resize(n);
    result.lambda.resize(n);
    result.Lambda.resize(n);
    for (unsigned int k = 0; k < n; ++k)
    {
      for (unsigned int c = 0; c < dim; ++c)
        result.jump[k][c] = residual[n_local * k + c];
      result.lambda[k] = residual[n_local * k + 3];
      result.Lambda[k] = {{residual[n_local * k + 4], residual[n_local * k + 5]}};
    }
    return result;
  }

  void ContactAssembler::add_forces(const ContactResidual &residual, Vector &force) const
  {
    const auto owned = surfaces_.owned_slave_nodes();
    for (unsigned int k = owned.first; k < owned.second; ++k)
      for (auto e = jump_.begin(k); e != jump_.end(k); ++e)
        for (unsigned int c = 0; c < dim; ++c)
          force(surfaces_.nodes()[e->node].dofs[c]) += e->weight * residual.jump[k][c];
    force.compress(dealii::VectorOperation::add);
  }

  double ContactAssembler::norm(const ContactResidual &residual, const double length) const
  {
    double norm = 0.;
    for (unsigned int k = 0; k < residual.lambda.size(); ++k)
    {
      const double area = weights_.area()[k];
      norm              = std::max(norm, std::abs(residual.lambda[k]) / (area * length));
      double scale      = area; // open or frictionless: the row is -m Lambda
      if (status_.friction(k))
        scale = -area * status_.threshold(k) *
                (status_.stick(k) ? length : 1. / status_.tangential_augmentation(k, status_.threshold(k)));
      norm = std::max(norm, std::hypot(residual.Lambda[k][0], residual.Lambda[k][1]) / scale);
    }
    return norm;
  }
} // namespace Nodus
