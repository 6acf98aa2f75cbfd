#include "contact/contact_assembler.h"
#include "contact/contact_law.h"
#include "contact/contact_scatter.h"
#include "parallel/largest.h"

#include <deal.II/base/mpi.h>

#include <Eigen/Dense>

#include <optional>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

    /// How the residual of a face changes with the pressures that the thresholds at its jumps follow.
    class ThresholdVariation
    {
    public:
      ThresholdVariation(const ContactSurfaces &surfaces, const SurfaceWeights &weights, const Status &status)
          : derivative_(surfaces.n_sites())
          , number_(surfaces.slave_nodes().size(), none)
      {
        // eq. T1: lambda_bar of slave nodes is (M S lambda)_j / m_j, lambda of integration points the interpolated one.
        for (const ContactPoint &point : weights.points())
          for (unsigned int b = 0; b < point.slaves.size(); ++b)
            if (point.site != none)
            {
              if (status.friction(point.site))
                accumulate(point.site, point.slaves[b], status.threshold_slope(point.site) * point.shape[b]);
            }
            else if (status.contact(point.slaves[b]))
              for (unsigned int a = 0; a < point.slaves.size(); ++a)
                if (const unsigned int k = point.slaves[a]; status.friction(k))
                  accumulate(k,
                             point.slaves[b],
                             status.threshold_slope(k) *
                                 (point.weight * point.shape[a] * point.shape[b] / weights.area()[k]));
      }

      void begin_face(const ContactPoint &point, const LawSum &sum)
      {
        for (const unsigned int k : slaves_)
          number_[k] = none;
        slaves_.clear();
        for (unsigned int a = 0; a < sum.first_node / 3; ++a)
          for (const auto &[k, derivative] : derivative_[jump_site(point, a)])
            if (number_[k] == none)
            {
              number_[k] = slaves_.size();
              slaves_.push_back(k);
            }
        variation_.setZero(sum.n_unknowns(), slaves_.size());
      }

      void add(const ContactPoint &point, const LawPoint &law, const LawSum &sum)
      {
        of_point_.setZero(slaves_.size());
        for (unsigned int a = 0; a < law.n_jumps; ++a)
          if (const double weight = threshold_weight(law, a); weight != 0.)
            for (const auto &[k, derivative] : derivative_[jump_site(point, a)])
              of_point_(number_[k]) += weight * derivative;
        variation_ +=
            Eigen::Map<const Eigen::VectorXd>(sum.by_threshold.data(), sum.n_unknowns()) * of_point_.transpose();
      }

      /// Slave nodes whose pressures the thresholds of the face follow, and a column for each.
      const std::vector<unsigned int> &slaves() const
      {
        return slaves_;
      }
      const Eigen::MatrixXd &variation() const
      {
        return variation_;
      }

    private:
      void accumulate(const unsigned int site, const unsigned int k, const double value)
      {
        for (auto &[slave, sum] : derivative_[site])
          if (slave == k)
          {
            sum += value;
            return;
          }
        derivative_[site].emplace_back(k, value);
      }

      /// d(mu lambda_s)/d lambda_k of every site whose friction follows the pressure.
      std::vector<std::vector<std::pair<unsigned int, double>>> derivative_;
      std::vector<unsigned int>                                 slaves_, number_; ///< number: of a slave in slaves_
      Eigen::VectorXd                                           of_point_;
      Eigen::MatrixXd                                           variation_;
    };

    LawStatus law_status(const Status &status, const unsigned int site)
    {
      return {status.contact(site), status.friction(site), status.stick(site)};
    }

    /// Where some nodes of the point are open the pressure of the others is that of their part of it.
    void give_way(const PressureGapLaw *const gap_law, LawPoint &law)
    {
      double closed = 0., lambda = 0.;
      for (unsigned int a = 0; a < law.n_nodes && gap_law != nullptr; ++a)
        if (law.nodes[a].status.contact)
        {
          closed += law.nodes[a].shape;
          lambda += law.nodes[a].shape * law.nodes[a].lambda;
        }
      const Closure closure = closed > 0. ? closure_at(gap_law, lambda / closed) : Closure();
      law.overclosure       = closed * closure.overclosure;
      law.compliance        = closure.compliance;
    }

    LawFrame law_frame(const SitePairing &pairing)
    {
      return {pairing.normal, pairing.tangent, pairing.tangent_free, pairing.friction_scale};
    }
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

  void ContactAssembler::gather(const ContactPoint &point, const ContactState &state, LawPoint &law) const
  {
    const bool pointwise = point.site != none;
    law.n_nodes          = point.slaves.size();
    law.n_jumps          = pointwise ? 1 : law.n_nodes;
    for (unsigned int a = 0; a < law.n_nodes; ++a)
    {
      const unsigned int k = point.slaves[a];
      law.nodes[a]         = {law_status(status_, pointwise ? point.site : k),
                              law_frame(pairing_[k]),
                              point.shape[a],
                              state.lambda[k],
                              state.Lambda[k],
                              state.elastic_slip[k]};
    }
    law.threshold = 0.;
    for (unsigned int a = 0; a < law.n_jumps; ++a)
    {
      const unsigned int s   = jump_site(point, a);
      const double       phi = pointwise ? 1. : point.shape[a];
      law.jumps[a]           = {law_status(status_, s),
                                law_frame(pairing_[s]),
                                phi,
                                distance(state, s),
                                jump_.jump_of_increment(s, state.increment)};
      law.threshold += phi * (law.jumps[a].status.friction ? status_.threshold(s) : 0.);
      Assert(!status_.contact(s) || phi == 0. || jump_.begin(s) != jump_.end(s),
             dealii::ExcMessage("the partner of a site in contact is not on this rank"));
    }
    law.weight                  = point.weight;
    law.normal_augmentation     = status_.normal_augmentation(point.slaves[0]);
    law.tangential_augmentation = status_.tangential_augmentation(point.slaves[0], law.threshold);
    law.in_the_mean             = pointwise && status_.projected(point.site);
    law.held                    = status_.holds_friction(jump_site(point, 0));
    law.elastic_slip            = status_.elastic_slip(point.slaves[0]);
    law.void_threshold          = pointwise ? status_.void_threshold(point.site) : 0.;
    law.void_weight             = law.void_threshold > 0.
                                      ? law.void_threshold / status_.tangential_augmentation(point.site, -law.void_threshold)
                                      : 1.;
    give_way(status_.pressure_gap_law(point.slaves[0]), law);
  }

  ContactResidual ContactAssembler::residual(const ContactState &state) const
  {
    ContactScatter scatter(surfaces_, pairing_, jump_, state);
    visit_points(state, false, nullptr, scatter);
    return scatter.finish();
  }

  ContactResidual
  ContactAssembler::assemble(const ContactState &state, LinearSystem &system, const bool linearise_threshold) const
  {
    const bool unsymmetric = linearise_threshold && status_.threshold_follows_pressure();
    system.contact.clear();
    system.variation.clear();
    system.border.clear();
    system.symmetric = !unsymmetric;
    ContactScatter scatter(surfaces_, pairing_, jump_, state);
    visit_points(state, unsymmetric, &system, scatter);
    const ContactResidual result = scatter.finish();
    scatter.fill_rhs(system);
    scatter.add_turns(result, system);
    system.multiplier_scale.assign(3 * surfaces_.n_owned_slave_nodes(), 1.); // eq. Q3
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
      if (result.friction_weight[k] > 0.)
        for (unsigned int i = 1; i < 3; ++i)
          system.multiplier_scale[3 * k + i] = weights_.area()[k] / result.friction_weight[k];
    return result;
  }

  void ContactAssembler::visit_points(const ContactState &state,
                                      const bool          unsymmetric,
                                      LinearSystem *const system,
                                      ContactScatter     &scatter) const
  {
    const unsigned int                rank = dealii::Utilities::MPI::this_mpi_process(surfaces_.layout().communicator);
    std::optional<ThresholdVariation> variation;
    if (unsymmetric)
      variation.emplace(surfaces_, weights_, status_);

    LawPoint law;
    LawSum   sum;
    law.linearise_threshold = unsymmetric;
    const auto &points      = weights_.points();
    for (auto begin = points.begin(), end = begin; begin != points.end(); begin = end)
    {
      // The points of a face have the same unknowns and are summed before their jumps are expanded; a point with a site
      // of its own has its own jump.
      const bool pointwise = begin->site != none;
      do
        ++end;
      while (!pointwise && end != points.end() && end->site == begin->site && end->slaves == begin->slaves);
      if (begin->owner != rank)
        continue;
      const unsigned int n_nodes = begin->slaves.size();
      sum.reset(pointwise ? 1 : n_nodes, n_nodes);
      if (unsymmetric)
        variation->begin_face(*begin, sum);
      for (auto point = begin; point != end; ++point)
      {
        gather(*point, state, law);
        add_contact_law(law, sum);
        scatter.add_friction_weight(*point, law);
        if (unsymmetric)
          variation->add(*point, law, sum);
      }
      scatter.add(*begin, sum);
      if (system != nullptr)
        scatter.add_tangent(*begin, sum, *system);
      if (unsymmetric)
        scatter.add_variation(*begin, sum, variation->slaves(), variation->variation(), *system);
      if (unsymmetric && law.in_the_mean) // eq. T5: the pressure that the threshold follows depends on the distance
        scatter.add_distance_variation(*begin,
                                       sum,
                                       -status_.threshold_slope(begin->site) * law.normal_augmentation *
                                           threshold_weight(law, 0),
                                       *system);
    }
  }

  void ContactAssembler::add_forces(const ContactResidual &residual, Vector &force) const
  {
    std::vector<Vector3> forces(surfaces_.nodes().size());
    for (unsigned int s = 0; s < surfaces_.n_sites(); ++s)
      if (surfaces_.is_owned(s))
        for (auto e = jump_.begin(s); e != jump_.end(s); ++e)
          forces[e->node] += jump_.force(s, *e, residual.jump[s]);
    surfaces_.add(forces, force);
  }

  double ContactAssembler::norm(const ContactResidual &residual, const double length) const
  {
    Largest norm;
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
    {
      const double area = weights_.area()[k];
      norm.add(residual.lambda[k] / (area * length));
      double scale = area; // open or frictionless: the row is -m Lambda
      if (residual.friction_weight[k] > 0.)
      {
        const double threshold = residual.friction_weight[k] / area;
        const bool   slips     = surfaces_.has_status(k) && (!status_.stick(k) || status_.projected(k));
        scale = area * threshold * (slips ? 1. / status_.tangential_augmentation(k, -threshold) : length);
      }
      norm.add(std::hypot(residual.Lambda[k][0], residual.Lambda[k][1]) / scale);
    }
    return norm.on_all_ranks(surfaces_.layout().communicator);
  }
} // namespace Nodus
