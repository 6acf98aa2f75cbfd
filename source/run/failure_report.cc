#include "run/failure_report.h"
#include "contact/pair_scales.h"
#include "contact/second_pass.h"
#include "parallel/all_gather.h"
#include "parallel/throw_everywhere.h"
#include "run/unheld_bodies.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int n_worst_nodes = 5, n_worst_sites = 6;

    /// Something on this rank, and what it is sorted by.
    template <typename Item>
    struct Ranked
    {
      double   value;
      DoFIndex number; ///< on the whole mesh or surface
      Item     item;

      bool operator<(const Ranked &other) const
      {
        return value != other.value ? value > other.value : number < other.number;
      }
      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &value &number &item;
      }
    };

    /// The first @p n of all ranks, the same on every rank: those with the largest value first. Collective.
    template <typename Item>
    std::vector<Item> first_of_all(std::vector<Ranked<Item>> items, const unsigned int n, const MPI_Comm communicator)
    {
      const auto keep = [&](std::vector<Ranked<Item>> &list)
      {
        std::sort(list.begin(), list.end());
        list.erase(list.begin() + std::min<std::size_t>(n, list.size()), list.end());
      };
      keep(items);
      std::vector<Ranked<Item>> all;
      for (const auto &part : all_gather(communicator, items))
        all.insert(all.end(), part.begin(), part.end());
      keep(all);
      std::vector<Item> first;
      for (const auto &ranked : all)
        first.push_back(ranked.item);
      return first;
    }

    std::array<double, dim> three(const double a, const double b, const double c)
    {
      return {{a, b, c}};
    }

    /// Nodes that are farthest from equilibrium.
    void find_worst_nodes(const FailedRun &p, FailureEvidence &evidence)
    {
      const ContactSurfaces           &surfaces = p.model.contact->surfaces();
      const OwnedNodes                 nodes(p.model.dof_handler, *p.model.mapping);
      const dealii::IndexSet          &owned = surfaces.layout().owned[0];
      std::map<DoFIndex, unsigned int> slaves; // by the first degree of freedom
      for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
        if (surfaces.has_status(k))
          slaves[surfaces.nodes()[surfaces.slave_nodes()[k].node].dofs[0]] = k;
      std::vector<Ranked<FailureEvidence::Node>> items;
      for (unsigned int n = 0; n < nodes.X.size(); ++n)
      {
        FailureEvidence::Node node;
        node.body            = nodes.body[n];
        node.X               = nodes.X[n];
        node.x               = nodes.X[n];
        const DoFIndex first = owned.nth_index_in_set(dim * n);
        if (const auto slave = slaves.find(first); slave != slaves.end())
        {
          node.pair     = given_pair(p.model.parameters.contact_pairs, surfaces.pair(slave->second));
          node.statuses = p.journal.diagnosis.statuses(slave->second);
        }
        for (unsigned int c = 0; c < dim; ++c)
        {
          node.force[c] = p.equilibrium.forces().out_of_balance(first + c);
          node.x[c] += p.states.now.unknowns.block(0)(first + c);
        }
        if (node.force.norm() > 0.)
          items.push_back({node.force.norm(), first, node});
      }
      evidence.worst_nodes = first_of_all(items, n_worst_nodes, p.model.communicator);
    }

    void find_changing_sites(const FailedRun &p, FailureEvidence &evidence)
    {
      const ContactInterface                    &contact  = *p.model.contact;
      const ContactSurfaces                     &surfaces = p.model.contact->surfaces();
      const Status                              &status   = contact.status();
      std::vector<Ranked<FailureEvidence::Site>> items;
      for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
        if (surfaces.is_owned(s) && status.ledger(s).changes > 0)
        {
          FailureEvidence::Site site{given_pair(p.model.parameters.contact_pairs, surfaces.pair(s)),
                                     surfaces.is_point(s),
                                     surfaces.site_position(s),
                                     Point(),
                                     status.ledger(s),
                                     p.journal.diagnosis.statuses(s)};
          if (site.is_point)
            for (auto e = contact.jump().begin(s); e < contact.jump().middle(s); ++e)
              site.x += e->weight * Vector3(contact.state().x[e->node]);
          else
            site.x = contact.state().x[surfaces.slave_nodes()[s].node];
          items.push_back({double(site.ledger.changes), surfaces.order(s), site});
        }
      evidence.n_changed_sites = dealii::Utilities::MPI::sum<unsigned int>(items.size(), p.model.communicator);
      evidence.changing_sites  = first_of_all(items, n_worst_sites, p.model.communicator);
    }

    /// Of the pairs that are given.
    void find_partners(const FailedRun &p, FailureEvidence &evidence)
    {
      const ContactInterface &contact  = *p.model.contact;
      const ContactSurfaces  &surfaces = p.model.contact->surfaces();
      const Status           &status   = contact.status();
      const Pairing          &pairing  = contact.pairing();
      const auto             &keys     = p.model.parameters.contact_pairs;
      const unsigned int      n_given =
          std::count_if(keys.begin(), keys.end(), [](const auto &pair) { return !pair.second_pass; });
      evidence.pairs.resize(n_given);
      std::vector<std::vector<Ranked<Point>>> lost(n_given);
      const std::vector<double>               stiffness = p.model.stiffness();
      for (unsigned int i = 0; i < n_given; ++i)
      {
        evidence.pairs[i].face_size        = surfaces.face_size(i);
        evidence.pairs[i].master_face_size = surfaces.master_face_size(i);
        if (status.has_friction(i))
          evidence.pairs[i].slave_over_master = slave_over_master(p.model.parameters, i, stiffness);
      }
      for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
      {
        if (!surfaces.is_owned(s) || !surfaces.has_status(s) || surfaces.pair(s) >= n_given)
          continue;
        FailureEvidence::Pair &pair = evidence.pairs[surfaces.pair(s)];
        ++pair.sites;
        pair.closed += status.contact(s);
        pair.slipping += status.contact(s) && status.status(s) == ContactStatus::slip;
        if (pairing[s].found)
        {
          const std::array<double, 2> slip = contact.slip(s);
          pair.sliding                     = std::max(pair.sliding, std::hypot(slip[0], slip[1]) / pair.face_size);
          if (!status.contact(s))
          {
            const double distance = contact.distance(s) / pair.face_size;
            pair.penetration      = std::max(pair.penetration, distance);
            pair.gap              = std::min(pair.gap, -distance);
          }
          continue;
        }
        ++pair.unpaired;
        if (!p.states.committed.contact.statuses.contact[s])
          continue;
        ++pair.lost;
        lost[surfaces.pair(s)].push_back({0., surfaces.order(s), surfaces.site_position(s)});
      }
      for (unsigned int i = 0; i < n_given; ++i)
      {
        FailureEvidence::Pair &pair = evidence.pairs[i];
        for (unsigned int *count : {&pair.sites, &pair.closed, &pair.slipping, &pair.unpaired, &pair.lost})
          *count = dealii::Utilities::MPI::sum(*count, p.model.communicator);
        for (double *value : {&pair.sliding, &pair.penetration})
          *value = dealii::Utilities::MPI::max(*value, p.model.communicator);
        pair.gap = dealii::Utilities::MPI::min(pair.gap, p.model.communicator);
        for (const Point &X : first_of_all(lost[i], 1, p.model.communicator))
          pair.lost_X = X;
        pair.reach = contact.geometry() != nullptr ? contact.geometry()->reach[i] : 0.;
      }
    }

    /// @returns the smallest det F at the quadrature points of each active cell of this rank.
    std::vector<float> find_distorted_cells(const FailedRun &p, FailureEvidence &evidence)
    {
      const Vector              u = p.model.with_ghosts(p.states.now.unknowns.block(0));
      const dealii::QGauss<dim> quadrature(p.model.parameters.degree + 1);
      dealii::FEValues<dim>     values(*p.model.mapping, p.model.fe, quadrature, dealii::update_gradients);
      const dealii::FEValuesExtractors::Vector displacement(0);
      std::vector<dealii::Tensor<2, dim>>      gradients(quadrature.size());
      std::vector<float>                       det_F(p.model.bodies.triangulation().n_active_cells(), 1.f);

      std::vector<Ranked<FailureEvidence::Cell>> worst; // of this rank
      for (const auto &cell : p.model.dof_handler.active_cell_iterators())
      {
        if (!cell->is_locally_owned())
          continue;
        values.reinit(cell);
        values[displacement].get_function_gradients(u, gradients);
        double smallest = std::numeric_limits<double>::max();
        for (const auto &gradient : gradients)
        {
          const double det = dealii::determinant(gradient + dealii::unit_symmetric_tensor<dim>());
          smallest         = std::isfinite(det) ? std::min(smallest, det) : -std::numeric_limits<float>::max();
        }
        det_F[cell->active_cell_index()] = smallest;
        evidence.inverted_cells += !(smallest > 0.);
        evidence.distorted_cells += !(smallest > Diagnosis::distorted);
        if (worst.empty() || smallest < worst.front().item.det_F)
        {
          dealii::Vector<double> nodal(p.model.fe.n_dofs_per_cell());
          cell->get_dof_values(u, nodal);
          Vector3 moved; // the mean of the nodes
          for (unsigned int i = 0; i < nodal.size(); ++i)
            moved[p.model.fe.system_to_component_index(i).first] += nodal[i] * dim / nodal.size();
          worst = {{-smallest,
                    cell->global_active_cell_index(),
                    {smallest, cell->material_id(), cell->center(), cell->center() + moved}}};
        }
      }
      for (unsigned int *count : {&evidence.inverted_cells, &evidence.distorted_cells})
        *count = dealii::Utilities::MPI::sum(*count, p.model.communicator);
      for (const FailureEvidence::Cell &cell : first_of_all(worst, 1, p.model.communicator))
        evidence.worst_cell = cell;
      return det_F;
    }

    /// The slave node of the multiplier that the linear solver found to be redundant.
    void find_repeated_constraint(const FailedRun &p, FailureEvidence &evidence)
    {
      const ContactInterface &contact    = *p.model.contact;
      const ContactSurfaces  &surfaces   = p.model.contact->surfaces();
      const BlockLayout      &layout     = surfaces.layout();
      const bool              pressure   = p.equilibrium.null_pivot() < layout.Lambda(0, 0);
      const DoFIndex          multiplier = pressure ? p.equilibrium.null_pivot() - layout.lambda(0)
                                                    : (p.equilibrium.null_pivot() - layout.Lambda(0, 0)) / 2;
      std::vector<Ranked<FailureEvidence::Constraint>> found;
      for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
        if (surfaces.multiplier(k) == multiplier)
        {
          const unsigned int          node = surfaces.slave_nodes()[k].node;
          FailureEvidence::Constraint constraint{given_pair(p.model.parameters.contact_pairs, surfaces.pair(k)),
                                                 surfaces.nodes()[node].X,
                                                 contact.pairing()[k].normal,
                                                 !pressure,
                                                 {}};
          for (unsigned int c = 0; c < dim; ++c)
            constraint.prescribed[c] = surfaces.fixed(node, c);
          found.push_back({0., multiplier, constraint});
        }
      for (const FailureEvidence::Constraint &constraint : first_of_all(found, 1, p.model.communicator))
        evidence.constraint = constraint;
    }

    /// Whether the softest motion is known, on the mesh at hand.
    bool has_motion(const FailedRun &p)
    {
      return p.softest_motion.size() == p.model.contact->surfaces().layout().n_u;
    }

    FailureEvidence evidence_of(const FailedRun &p, const SolverFailure &failure, const bool may_shrink)
    {
      // Contact at the last iterate, whose bulk may be the reason why the rest of its residual was not computed.
      ContactInterface &contact = *p.model.contact;
      contact.gather(p.states.now.unknowns, p.states.committed.unknowns.block(0));
      contact.evaluate();

      const Increment &increment = p.equilibrium.increment();
      FailureEvidence  evidence;
      evidence.kind          = failure.kind();
      evidence.message       = failure.what();
      evidence.converged     = increment.begin;
      evidence.linear_solver = p.equilibrium.solver_type();
      evidence.force_scale   = p.equilibrium.forces().scale;
      evidence.may_shrink    = may_shrink;
      evidence.unstable      = p.equilibrium.unstable();
      evidence.relaxed       = p.journal.counts.remedies[Remedy::relaxation] > 0;
      evidence.motion_known  = has_motion(p);
      find_worst_nodes(p, evidence);
      find_changing_sites(p, evidence);
      find_partners(p, evidence);
      for (const Measure measure : {Measure::penetration, Measure::unseen_depth, Measure::passed})
        if (const Verdict::Finding &finding = p.journal.verdict[measure];
            failure.kind() == SolverFailure::Kind::judged && !finding.holds() &&
            finding.pair < p.model.parameters.contact_pairs.size())
          evidence.pairs[given_pair(p.model.parameters.contact_pairs, finding.pair)].intruded = true;
      if (failure.kind() == SolverFailure::Kind::over_constraint)
        find_repeated_constraint(p, evidence);
      for (const auto &motion : free_motions(p.model, p.states.now, increment.end))
        evidence.free_motions.push_back(motion.text);
      for (const auto &motion : free_motions(p.model, p.states.now, increment.end, true))
        evidence.left_free.push_back(motion.text);
      evidence.springs = proposed_springs(p.model, p.states.now, increment.end);
      return evidence;
    }

    /// Fields of the state that failed, as one file of the bodies.
    void write_failed_state(const FailedRun &p, const std::string &name, const std::vector<float> &det_F)
    {
      const ContactSurfaces           &surfaces       = p.model.contact->surfaces();
      const std::vector<ContactFields> contact_fields = p.model.contact->fields();
      // Three values to a node; off the slave surfaces they are zero.
      const auto at_slave_nodes = [&](const auto &values)
      {
        Vector                    v(surfaces.layout().owned[0], p.model.communicator);
        std::vector<unsigned int> place(surfaces.n_pairs(), 0); // of the next node among the fields of its pair
        for (unsigned int k = 0; k < surfaces.slave_nodes().size(); ++k)
        {
          const SlaveNode              &slave = surfaces.slave_nodes()[k];
          const std::array<double, dim> value = values(contact_fields[slave.pair], place[slave.pair]++);
          if (k < surfaces.n_owned_slave_nodes())
            for (unsigned int c = 0; c < dim; ++c)
              v(surfaces.nodes()[slave.node].dofs[c]) = value[c];
        }
        v.compress(dealii::VectorOperation::insert);
        return p.model.with_ghosts(v);
      };
      std::vector<VtuOutput::NodalField> fields;
      fields.reserve(6); // a copy would not have the ghosts
      fields.push_back({{"residual_force"}, p.model.with_ghosts(p.equilibrium.forces().out_of_balance)});
      if (has_motion(p))
        fields.push_back({{"softest_motion"}, p.model.with_ghosts(p.softest_motion)});
      if (surfaces.n_pairs() > 0)
      {
        fields.push_back(
            {{"CPRESS", "COPEN", "CSTATUS"},
             at_slave_nodes([](const ContactFields &f, const unsigned int i)
                            { return three(f.pressure[i], f.gap[i], static_cast<double>(f.status[i])); })});
        fields.push_back({{"status_changes", "cycle_period", "contradiction"},
                          at_slave_nodes(
                              [](const ContactFields &f, const unsigned int i) {
                                return three(
                                    double(f.status_changes[i]), double(f.cycle_period[i]), double(f.contradiction[i]));
                              })});
        fields.push_back(
            {{"pair", "paired", "area"},
             at_slave_nodes([&](const ContactFields &f, const unsigned int i)
                            { return three(1. + (&f - contact_fields.data()), double(f.paired[i]), f.area[i]); })});
        fields.push_back({{"friction_traction"},
                          at_slave_nodes([](const ContactFields &f, const unsigned int i)
                                         { return three(f.friction[i][0], f.friction[i][1], f.friction[i][2]); })});
      }
      p.results.vtu()->write_state(
          name, p.equilibrium.increment().end, p.model.with_ghosts(p.states.now.unknowns.block(0)), fields, det_F);
    }
  } // namespace

  std::string report_failure(const FailedRun &p, const SolverFailure &failure, const bool may_shrink)
  {
    const auto timer = p.journal.profile.time(Phase::output);
    try
    {
      FailureEvidence          evidence = evidence_of(p, failure, may_shrink);
      const std::vector<float> det_F    = find_distorted_cells(p, evidence);
      if (const VtuOutput *const vtu = p.results.vtu())
      {
        evidence.state = vtu->state_file("failed_state");
        write_failed_state(p, "failed_state", det_F);
      }
      throw_everywhere<InputError>(p.journal.diagnosis.write(evidence), p.model.communicator);
      return ". Suspected: " + p.journal.diagnosis.summary(evidence) + " (" + p.model.parameters.output.results_folder +
             "/diagnosis.md says more)";
    }
    catch (const InputError &error)
    {
      return std::string(". There is no diagnosis: ") + error.what();
    }
  }
} // namespace Nodus
