#include "run/judge.h"
#include "mesh/sides.h"
#include "parallel/largest.h"
#include "parallel/owned_values.h"
#include "run/body_balance.h"
#include "run/increment_loops.h"
#include "run/state_visitors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// Forces, laws and thresholds may violate their equations by so many times what their loop asks for.
    constexpr double allowance = 10.;
    /// ... and by this: what pairing from another state finds is the same up to round-off alone.
    constexpr double round_off = 1e-6;
    /// The resultant of a body and that of a pair, relative; the moment of a pair in forces times mean faces.
    constexpr double body_tolerance = 1e-6, pair_force_tolerance = 1e-9, pair_moment_tolerance = 1e-8;
    /// Of contradicted statuses, of the largest pressure or of the cone.
    constexpr double status_tolerance = 1e-3;

    /// Whether the numbers of a State on this rank are finite.
    struct Finite
    {
      Largest largest;

      template <typename T>
      void sites(const std::vector<T> &values)
      {
        double numbers[2 * dim];
        for (const T &value : values)
          for (const double *number = numbers, *const end = StateVisitors::write(value, numbers); number != end;
               ++number)
            largest.add(*number);
      }
      template <typename T>
      void slaves(const std::vector<T> &values)
      {
        sites(values);
      }
      void nodes(const Vector &v)
      {
        const double *const values = v.begin();
        for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
          largest.add(values[i]);
      }
      void multipliers(const Vector &v, unsigned int)
      {
        nodes(v);
      }
      void cells(const SolidAssembler::History &) // the forces follow from them
      {
      }
      void common(const double number)
      {
        largest.add(number);
      }
      void common(const bool)
      {
      }
      void common(const std::vector<RigidBodies::State> &bodies)
      {
        for (const RigidBodies::State &body : bodies)
        {
          for (unsigned int c = 0; c < dim; ++c)
          {
            largest.add(body.translation[c]);
            largest.add(body.turn[c]);
            largest.add(body.prescribed_rotation[c]);
          }
          largest.add(body.rotation.norm());
          for (const double force : body.applied)
            largest.add(force);
        }
      }
      void common(const Energies &energies)
      {
        largest.add(energies.imbalance());
      }
    };
  } // namespace

  Judge::Judge(const Model &model, const States &states, const Equilibrium &equilibrium)
      : model_(model)
      , states_(states)
      , equilibrium_(equilibrium)
  {
  }

  void Judge::begin_on_mesh()
  {
    contact_.reset();
    larger_face_.clear();
    smaller_face_.clear();
  }

  Verdict Judge::judge(const double rest)
  {
    rest_ = rest;
    if (!contact_)
      set_up();
    Verdict verdict;
    measure_numbers(verdict);
    if (!verdict.holds())
      return verdict;
    pair_anew();
    measure_contact(verdict);
    measure_pairs(verdict);
    measure_forces(verdict);
    measure_held(verdict);
    measure_intrusion(verdict);
    return verdict;
  }

  void Judge::set_up()
  {
    contact_ = std::make_unique<ContactInterface>(model_.parameters.contact_pairs,
                                                  model_.stiffness(),
                                                  model_.parameters.strategy,
                                                  model_.bodies,
                                                  model_.dof_handler,
                                                  *model_.mapping,
                                                  model_.rigid_bodies,
                                                  interface_state_);
    nodes_   = std::make_unique<OwnedNodes>(model_.dof_handler, *model_.mapping);
    // a vector keeps its partition where only the sizes are those of another one
    contact_->surfaces().layout().reinit(unknowns_);
    for (unsigned int p = 0; p < model_.parameters.contact_pairs.size(); ++p)
    {
      const double slave = contact_->surfaces().face_size(p), master = contact_->surfaces().master_face_size(p);
      larger_face_.push_back(std::max(slave, master));
      smaller_face_.push_back(std::min(slave, master));
    }
  }

  void Judge::pair_anew()
  {
    const Increment &increment = equilibrium_.increment();
    const Vector    &start     = states_.committed.unknowns.block(0);
    unknowns_                  = states_.now.unknowns;
    interface_state_           = states_.now.contact;
    contact_->surfaces().set_fixed(model_.boundary_conditions->homogeneous_constraints());
    contact_->begin_increment(increment.begin, increment.end, model_.resolved_interference(increment.end));
    contact_->resume(unknowns_, start);
    contact_->take_laws(*model_.contact);
    if (model_.parameters.geometry_loop.mode == LoopParameters::Mode::once)
    {
      unknowns_.block(0) = start;
      contact_->pair(unknowns_, start);
      unknowns_.block(0) = states_.now.unknowns.block(0);
      contact_->gather(unknowns_, start);
    }
    else
      contact_->pair(unknowns_, start);
    contact_->evaluate();

    const NormScales least(model_, unknowns_.block(0), start, states_.now.stiffness_scale);
    length_ = least.length;
    force_  = least.force;
  }

  /// Of forces and laws: a geometry loop that does not settle may leave more than Newton's method.
  double Judge::tolerance(const double of_newton) const
  {
    const double of_loop = model_.parameters.geometry_loop.tolerance;
    return std::max({allowance * of_newton,
                     round_off,
                     equilibrium_.merged().geometry ? 0. : allowance * of_loop,
                     rest_ > 0. ? 2. * IncrementLoops::tolerated_rest(of_loop) : 0.});
  }

  void Judge::measure_numbers(Verdict &verdict) const
  {
    Finite finite;
    visit_members(states_.now, finite);
    verdict[Measure::numbers].value = std::isinf(finite.largest.on_all_ranks(model_.communicator)) ? 1. : 0.;
  }

  void Judge::measure_contact(Verdict &verdict)
  {
    const Parameters &parameters   = model_.parameters;
    verdict[Measure::contact_laws] = {contact_->norm(length_), tolerance(parameters.newton.contact_tolerance), ""};
    const Status::Violation contra = contact_->violation();
    verdict[Measure::statuses]     = {contra.value, status_tolerance, contact_->locus(contra.site)};
    verdict[Measure::thresholds]   = {0., allowance * parameters.threshold_loop.tolerance, ""};
    if (!contact_->has_friction())
      return;
    const Status::Change change        = contact_->threshold_change(equilibrium_.increment().duration());
    verdict[Measure::thresholds].value = change.value;
    verdict[Measure::thresholds].where = contact_->locus(change.site);
  }

  void Judge::measure_pairs(Verdict &verdict) const
  {
    const ContactSurfaces &surfaces = contact_->surfaces();
    std::vector<double>    sums(4 * surfaces.n_pairs(), 0.); // of forces, and the moment of surfaces that are adjusted
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      if (surfaces.is_owned(s))
      {
        const Vector3 &force = contact_->residual().jump[s];
        const Vector3  moment =
            contact_->status().adjustment(s) * dealii::cross_product_3d(contact_->pairing()[s].normal, force);
        double *const sum = sums.data() + 4 * surfaces.pair(s);
        sum[0] += force.norm();
        for (unsigned int c = 0; c < dim; ++c)
          sum[1 + c] += moment[c];
      }
    dealii::Utilities::MPI::sum(sums, model_.communicator, sums);
    const std::vector<ContactResultants> resultants = contact_->resultants();

    Verdict::Finding &forces = verdict[Measure::pair_forces], &moments = verdict[Measure::pair_moments];
    forces.tolerance  = pair_force_tolerance;
    moments.tolerance = pair_moment_tolerance;
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
      if (const double *const sum = sums.data() + 4 * p; sum[0] > 0.)
      {
        const ContactResultants &r     = resultants[p];
        const std::string        where = pair_label(model_.parameters.contact_pairs, p);
        const Vector3            adjusted({sum[1], sum[2], sum[3]});
        forces.raise((r.slave_force + r.master_force).norm() / sum[0], where);
        moments.raise((r.slave_moment + r.master_moment + adjusted).norm() / (sum[0] * larger_face_[p]), where);
      }
  }

  /// Eq. N3, and its sum over each body.
  void Judge::measure_forces(Verdict &verdict)
  {
    const double       t           = equilibrium_.increment().end;
    const auto        &constraints = model_.boundary_conditions->homogeneous_constraints();
    const NodalForces &given       = equilibrium_.forces();
    const Vector       u           = model_.with_ghosts(unknowns_.block(0));
    Vector             internal, external, contact;
    for (const auto &[v, map] :
         {std::make_pair(&internal, &given.internal), {&external, &given.external}, {&contact, &given.contact}})
      v->reinit(*map, true);
    model_.solid->forces(u, t, internal, external, &inner_energy_);
    external += given.released;
    external += given.drag;
    contact = 0.;
    contact_->add_forces(contact);
    const double scale = std::max({largest_entry(internal), largest_entry(external), largest_entry(contact), force_});

    Vector &missing = internal;
    missing -= external;
    missing += contact;
    const double      rigid = rigid_body_imbalance(model_, missing, contact_->residual(), scale);
    const OwnedValues owned(missing);
    for (const auto i : contact_->surfaces().layout().owned[0])
      if (constraints.is_constrained(i))
        owned(i) = 0.;
    contact -= external;
    verdict[Measure::nodes] = {
        std::max(largest_entry(missing) / scale, rigid), tolerance(model_.parameters.newton.force_tolerance), ""};
    verdict[Measure::bodies]           = body_imbalance(model_, *nodes_, unknowns_.block(0), missing, contact, scale);
    verdict[Measure::bodies].tolerance = std::max(body_tolerance, tolerance(model_.parameters.newton.force_tolerance));

    Largest     prescribed;
    const auto &next = model_.boundary_conditions->increment_constraints(u);
    for (const auto i : contact_->surfaces().layout().owned[0])
      if (next.is_constrained(i))
        prescribed.add(next.get_inhomogeneity(i) / length_);
    verdict[Measure::prescribed] = {
        prescribed.on_all_ranks(model_.communicator), allowance * model_.parameters.newton.contact_tolerance, ""};
  }
} // namespace Nodus
