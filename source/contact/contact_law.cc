#include "contact/contact_law.h"

#include <deal.II/base/exceptions.h>

#include <Eigen/Dense>

namespace Nodus
{
  namespace
  {
    using Matrix3 = Eigen::Matrix3d;
    using Column3 = Eigen::Vector3d;
    using Rows23  = Eigen::Matrix<double, 2, 3>;

    constexpr int max_unknowns = LawSum::max_unknowns;
    using LocalMatrix =
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_unknowns, max_unknowns>;
    using LocalVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_unknowns, 1>;
    using Tangent     = Eigen::Map<LocalMatrix>;
    using Residual    = Eigen::Map<LocalVector>;

    constexpr double on_the_sphere = 1e-7; ///< see direction()

    Column3 eigen(const Vector3 &v)
    {
      return {v[0], v[1], v[2]};
    }

    /// Shape function times the filter of each filtered field (eq. 32, 33, W3).
    struct Filtered
    {
      double contact; ///< phi S
      double open;    ///< phi (1 - S)
      double stick;   ///< phi S S_f, 0 where frictionless
      double slip;    ///< phi S (1 - S_f), 0 where frictionless
    };

    Filtered filter(const LawStatus &status, const double phi, const bool in_the_mean)
    {
      // regularised, the projection of the slip rows decides between stick and slip (eq. F3)
      const bool stick = status.stick && !in_the_mean;
      return {status.contact ? phi : 0.,
              status.contact ? 0. : phi,
              status.friction && stick ? phi : 0.,
              status.friction && !stick ? phi : 0.};
    }

    struct Node : Filtered
    {
      double  void_tangent[2];    ///< phi where Lambda_i has no friction to carry: open or frictionless
      double  blocked_tangent[2]; ///< phi^2 where nothing can slip along tangent i: Lambda_i is zero by itself
      Rows23  tangent;            ///< rows: free tangents, zero where blocked
      Column3 axis[2];            ///< both tangents
      double  Lambda[2];          ///< components along both
    };

    struct Jump : Filtered
    {
      Column3 normal;
      Matrix3 projector; ///< P: on the free tangents, times the friction scale of each (eq. P4)
    };

    /// Filtered fields at the point (eq. W4), and all that rows and columns are made of.
    struct Fields
    {
      unsigned int n_nodes, n_jumps;
      Node         nodes[LawPoint::max_nodes];
      Jump         jumps[LawPoint::max_nodes];
      double       lambda_c = 0., lambda_o = 0., distance = 0.;
      /// With elastic slip slip_stick is what friction that sticks leaves of the slip, slip_slip the trial (eq. F4).
      Column3 Lambda_stick = Column3::Zero(), slip_stick = Column3::Zero(), Lambda_slip = Column3::Zero(),
              slip_slip      = Column3::Zero();
      Column3 Lambda_void[2] = {Column3::Zero(), Column3::Zero()};
      bool    slips          = false, held;
      double  W, Wt; ///< weight, and weight times threshold
      double  threshold, h_n, h_tau, void_weight;
      double  stiffness; ///< 0, or h_n where regularised (eq. F3)
      double  overclosure, compliance, elastic_slip;
      Column3 pi  = Column3::Zero();
      Matrix3 K_B = Matrix3::Zero();
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

    void add_node(const LawNode &from, const LawPoint &point, Node &node, Fields &f)
    {
      static_cast<Filtered &>(node) = filter(from.status, from.shape, point.in_the_mean);
      for (unsigned int i = 0; i < 2; ++i)
      {
        const bool free         = from.frame.tangent_free[i];
        node.void_tangent[i]    = free && !from.status.friction ? from.shape : 0.;
        node.blocked_tangent[i] = free ? 0. : from.shape * from.shape;
        node.axis[i]            = eigen(from.frame.tangent[i]);
        node.tangent.row(i)     = free ? node.axis[i].transpose().eval() : Column3::Zero().transpose().eval();
        node.Lambda[i]          = from.Lambda[i];
        f.Lambda_void[i] += node.void_tangent[i] * from.Lambda[i] * node.axis[i];
      }
      const Column3 Lambda = node.tangent.transpose() * Eigen::Vector2d(from.Lambda[0], from.Lambda[1]);
      f.lambda_c += node.contact * from.lambda;
      f.lambda_o += node.open * from.lambda;
      f.Lambda_stick += node.stick * Lambda;
      f.Lambda_slip += node.slip * Lambda;
      if (point.elastic_slip > 0.) // eq. F4
      {
        const Column3 before = node.tangent.transpose() * (node.tangent * eigen(from.elastic_slip));
        f.slip_stick += node.stick * (before - point.elastic_slip * Lambda);
        f.slip_slip += node.slip * before;
      }
      f.slips = f.slips || node.slip != 0.;
    }

    void add_jump(const LawJump &from, const bool in_the_mean, Jump &jump, Fields &f)
    {
      static_cast<Filtered &>(jump) = filter(from.status, from.shape, in_the_mean);
      jump.normal                   = eigen(from.frame.normal);
      jump.projector.setZero();
      for (unsigned int i = 0; i < 2; ++i)
        if (from.frame.tangent_free[i])
        {
          const Column3 t = eigen(from.frame.tangent[i]);
          jump.projector += from.frame.friction_scale[i] * t * t.transpose();
        }
      const Column3 slip = jump.projector * eigen(from.slip);
      f.distance += jump.contact * from.distance;
      f.slip_stick += jump.stick * slip;
      f.slip_slip += jump.slip * slip;
    }

    void evaluate(const LawPoint &point, Fields &f)
    {
      f.n_nodes = point.n_nodes;
      f.n_jumps = point.n_jumps;
      for (unsigned int a = 0; a < f.n_nodes; ++a)
        add_node(point.nodes[a], point, f.nodes[a], f);
      for (unsigned int a = 0; a < f.n_jumps; ++a)
        add_jump(point.jumps[a], point.in_the_mean, f.jumps[a], f);
      f.W         = point.weight;
      f.Wt        = point.weight * point.threshold;
      f.threshold = point.threshold;
      f.h_n       = point.normal_augmentation;
      f.h_tau     = point.tangential_augmentation;
      f.held      = point.held;

      f.void_weight  = point.void_weight;
      f.overclosure  = point.overclosure;
      f.compliance   = point.compliance;
      f.elastic_slip = point.elastic_slip;
      // the normal law of a point is projected, too: its pressure is lambda - h_n d_n where that is negative (eq. F3)
      f.stiffness = point.in_the_mean ? f.h_n : 0.;
      if (f.slips && f.held) // Lambda stays as it is (theory section 14, held friction)
        f.pi = f.Lambda_slip;
      else if (f.slips)
        direction(f.Lambda_slip + f.h_tau * f.slip_slip, f.pi, f.K_B);
    }

    /// Rows of the displacements: the virtual work of the contact and friction tractions, and its derivative.
    void add_forces(const Fields &f, Residual &r, Tangent &A)
    {
      const unsigned int first = 3 * f.n_jumps;
      const double       W = f.W, Wt = f.Wt;
      for (unsigned int a = 0; a < f.n_jumps; ++a)
      {
        const Jump        &i  = f.jumps[a];
        const unsigned int ia = 3 * a;
        // Minus the force on the slave side (eq. 49-54): its pressure, its friction where it sticks, and where it
        // slips.
        Column3 force = -W * i.contact * (f.lambda_c - f.stiffness * f.distance) * i.normal;
        force.noalias() -= Wt * i.stick * i.projector * f.Lambda_stick;
        force.noalias() -= Wt * i.slip * i.projector * f.pi;
        r.segment<3>(ia) += force;

        for (unsigned int c = 0; c < f.n_nodes; ++c)
        {
          const Node        &j  = f.nodes[c];
          const unsigned int jc = first + 3 * c;
          A.block<3, 1>(ia, jc) -= W * i.contact * j.contact * i.normal;                             // eq. 38, 42
          A.block<3, 2>(ia, jc + 1) -= Wt * i.stick * j.stick * i.projector * j.tangent.transpose(); // eq. 39, 43
          if (f.slips)                                                                               // eq. 40, 44
            A.block<3, 2>(ia, jc + 1) -= Wt * i.slip * j.slip * i.projector * f.K_B * j.tangent.transpose();
        }
        // The regularised normal law, which belongs to points with one jump: second term of eq. 36, 37, 41.
        if (f.stiffness > 0. && i.contact != 0.)
          A.block<3, 3>(ia, ia) += W * f.stiffness * i.normal * i.normal.transpose();
        if (f.slips)
          for (unsigned int c = 0; c < f.n_jumps; ++c) // eq. 36, 37, 41
            A.block<3, 3>(ia, 3 * c) +=
                -Wt * f.h_tau * i.slip * f.jumps[c].slip * i.projector * f.K_B * f.jumps[c].projector;
      }
    }

    /// Rows of the multipliers: the contact law and the friction law, and their derivative.
    void add_laws(const Fields &f, Residual &r, Tangent &A)
    {
      const unsigned int first = 3 * f.n_jumps;
      const double       W = f.W, Wt = f.Wt;
      for (unsigned int a = 0; a < f.n_nodes; ++a)
      {
        const Node        &i  = f.nodes[a];
        const unsigned int ia = first + 3 * a;
        // The contact law (eq. 55, 56): no pressure where open, no distance in contact.
        // With a pressure-gap law it is the distance that the pressure gives (eq. C1).
        r(ia) += -W * i.open * f.lambda_o / f.h_n - W * i.contact * (f.distance - f.overclosure);
        // The friction law (eq. 57-59): no slip where it sticks, the direction of slip where it slips; the plus before
        // the second term is what makes the tangent symmetric.
        Eigen::Vector2d law = -Wt * i.stick * i.tangent * f.slip_stick;
        law.noalias() += (Wt / f.h_tau) * i.slip * i.tangent * (f.Lambda_slip - f.pi);
        r.segment<2>(ia + 1) += law;
        // No friction multiplier where there is no friction (eq. 57-59).
        for (unsigned int t = 0; t < 2 && !f.held; ++t)
          r(ia + 1 + t) -= W * (f.void_weight * i.void_tangent[t] * f.Lambda_void[t].dot(i.axis[t]) +
                                i.blocked_tangent[t] * i.Lambda[t]);
        for (unsigned int c = 0; c < f.n_nodes; ++c)
        {
          const Node        &j  = f.nodes[c];
          const unsigned int jc = first + 3 * c;
          A(ia, jc) -= W / f.h_n * i.open * j.open + W * f.compliance * i.contact * j.contact; // eq. 45, C2
          A.block<2, 2>(ia + 1, jc + 1) +=
              Wt * f.elastic_slip * i.stick * j.stick * i.tangent * j.tangent.transpose(); // eq. F5
          if (f.slips)                                                                     // eq. 46
            A.block<2, 2>(ia + 1, jc + 1) +=
                Wt / f.h_tau * i.slip * j.slip * i.tangent * (Matrix3::Identity() - f.K_B) * j.tangent.transpose();
          for (unsigned int t = 0; t < 2; ++t) // eq. 47
            A(ia + 1 + t, jc + 1 + t) -=
                W * (f.void_weight * i.void_tangent[t] * j.void_tangent[t] * i.axis[t].dot(j.axis[t]) +
                     (a == c ? i.blocked_tangent[t] : 0.));
        }
      }
      // The rows of the multipliers in the columns of the jumps are those of the forces, transposed.
      A.block(first, 0, 3 * f.n_nodes, first) = A.block(0, first, first, 3 * f.n_nodes).transpose();
    }

    /// Derivative of the point's residual with respect to its threshold (eq. T3, T4).
    void derive_by_threshold(const Fields &f, Residual &r_t)
    {
      const unsigned int first = 3 * f.n_jumps;
      const double       W = f.W, Wt = f.Wt;
      // h_tau ~ 1/threshold (eq. T2)
      const bool    stuck = f.n_nodes > 1 || f.elastic_slip > 0.;
      const Column3 pi_t  = f.slips ? Column3(f.K_B * f.slip_slip * (f.h_tau / -f.threshold)) : f.pi;
      for (unsigned int a = 0; a < f.n_jumps; ++a)
      {
        const Jump &i         = f.jumps[a];
        r_t.segment<3>(3 * a) = -W * i.projector * ((stuck ? i.stick : 0.) * f.Lambda_stick + i.slip * f.pi) -
                                Wt * i.slip * i.projector * pi_t;
      }
      for (unsigned int a = 0; a < f.n_nodes; ++a)
      {
        const Node        &i   = f.nodes[a];
        const unsigned int ia  = first + 3 * a;
        r_t(ia)                = 0.;
        r_t.segment<2>(ia + 1) = -(Wt / f.h_tau) * i.slip * i.tangent * pi_t;
        if (f.n_nodes > 1 && f.stiffness > 0.) // regularised: a law of the point
          r_t.segment<2>(ia + 1) += (2. * W / f.h_tau) * i.slip * i.tangent * (f.Lambda_slip - f.pi);
      }
    }
  } // namespace

  void LawSum::reset(const unsigned int n_jumps, const unsigned int nodes)
  {
    Assert(nodes <= LawPoint::max_nodes && n_jumps <= LawPoint::max_nodes,
           dealii::ExcMessage("more nodes than a face of degree 2 has"));
    n_nodes              = nodes;
    first_node           = 3 * n_jumps;
    const unsigned int n = n_unknowns();
    Tangent(matrix.data(), n, n).setZero();
    Residual(residual.data(), n).setZero();
  }

  void add_contact_law(const LawPoint &point, LawSum &sum)
  {
    const unsigned int n = sum.n_unknowns();
    Assert(sum.first_node == 3 * point.n_jumps && sum.n_nodes == point.n_nodes,
           dealii::ExcMessage("the sum has other unknowns than the point"));
    Tangent  A(sum.matrix.data(), n, n);
    Residual r(sum.residual.data(), n);
    Fields   f;
    evaluate(point, f);
    add_forces(f, r, A);
    add_laws(f, r, A);
    if (point.linearise_threshold)
    {
      Residual r_t(sum.by_threshold.data(), n);
      derive_by_threshold(f, r_t);
    }
  }

  double threshold_weight(const LawPoint &point, const unsigned int a)
  {
    const Filtered f = filter(point.jumps[a].status, point.jumps[a].shape, point.in_the_mean);
    return f.slip != 0. || (f.stick != 0. && (point.n_nodes > 1 || point.elastic_slip > 0.)) ? f.contact : 0.;
  }
} // namespace Nodus
