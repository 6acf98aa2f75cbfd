#include "base/complete_file.h"
#include "bulk/rigid_material.h"
#include "contact/tractions.h"
#include "run/contact_problem_implementation.h"
#include <nodus/base/signals.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace Nodus
{
  namespace
  {
    std::vector<std::unique_ptr<Material>> make_materials(const std::vector<BodyParameters> &bodies)
    {
      std::vector<std::unique_ptr<Material>> materials;
      double                                 stiffest = 0.; // with its modulus a rigid body changes no scale
      for (const auto &body : bodies)
      {
        materials.push_back(body.rigid ? nullptr : make_material(body.material));
        if (!body.rigid)
          stiffest = std::max(stiffest, materials.back()->youngs_modulus());
      }
      for (auto &material : materials)
        if (!material)
          material = std::make_unique<RigidMaterial>(stiffest);
      return materials;
    }

    bool refines(const AdaptivityParameters &adaptivity)
    {
      return adaptivity.interval > 0 || adaptivity.initial_cycles > 0 || adaptivity.repetitions > 0;
    }

    std::vector<RegionParameters> slaves(const std::vector<ContactPairParameters> &pairs)
    {
      std::vector<RegionParameters> result;
      for (const auto &pair : pairs)
        result.push_back(pair.slave);
      return result;
    }
  } // namespace

  ContactProblem::Implementation::Implementation(const Parameters &p, MPI_Comm comm, std::ostream &log)
      : parameters(p)
      , communicator(comm)
      , console(log, dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      , bodies(parameters.bodies, comm, refines(parameters.adaptivity), slaves(parameters.contact_pairs))
      , mapping(bodies.make_mapping(parameters.degree))
      , fe(dealii::FE_Q<dim>(parameters.degree), dim)
      , dof_handler(bodies.triangulation())
      , materials(make_materials(parameters.bodies))
      , path(parameters.load_stepping)
      , checkpoints(parameters.output.results_folder, comm)
      , diagnosis(parameters, comm)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1 && !parameters.contact_pairs.empty())
      balance_contact(parameters.contact_pairs, *mapping, bodies);
    rigid_bodies = std::make_unique<RigidBodies>(parameters.bodies, bodies);
    set_up_mesh();
    profile.set_ground(Phase::other);
  }

  /// All that is made for the mesh as it is; the state is that at rest.
  void ContactProblem::Implementation::set_up_mesh()
  {
    geometry.reset();
    dof_handler.distribute_dofs(fe);
    relevant.clear();
    dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
    boundary_conditions = std::make_unique<BoundaryConditions>(parameters.boundary_conditions,
                                                               bodies,
                                                               dof_handler,
                                                               *mapping,
                                                               parameters.load_stepping.interval_ends,
                                                               parameters.bodies);
    std::vector<BodyParameters::VolumetricTreatment> treatments;
    for (const auto &body : parameters.bodies)
      treatments.push_back(body.rigid ? BodyParameters::VolumetricTreatment::standard : body.volumetric_treatment);
    solid =
        std::make_unique<SolidAssembler>(dof_handler, *mapping, materials, boundary_conditions->loads(), treatments);
    stabilisation = std::make_unique<ViscousStabilisation>(
        parameters.load_stepping.viscous_stabilisation, bodies, materials, dof_handler, *mapping);
    surfaces = std::make_unique<ContactSurfaces>(parameters.contact_pairs, bodies, dof_handler, *mapping);
    surfaces->set_fixed(boundary_conditions->homogeneous_constraints());
    rigid_bodies->find_nodes(dof_handler, *mapping);
    std::vector<unsigned int> rigid_numbers(bodies.size(), dealii::numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < rigid_bodies->size(); ++i)
      rigid_numbers[rigid_bodies->body(i)] = i;
    surfaces->set_rigid_bodies(rigid_numbers);
    // rho_n = factor E/h: the stiffness of a layer one slave face deep, of the softer material
    const std::vector<double> stiffness = pair_stiffness();
    std::vector<double>       augmentation;
    for (unsigned int p = 0; p < parameters.contact_pairs.size(); ++p)
      augmentation.push_back(parameters.contact_pairs[p].normal_augmentation_factor * stiffness[p] /
                             surfaces->face_size(p));
    status  = std::make_unique<Status>(parameters.contact_pairs, *surfaces, augmentation, stiffness);
    contact = std::make_unique<ContactAssembler>(*surfaces, pairing, jump, weights, *status);

    const BlockLayout &layout = surfaces->layout();
    system.layout             = &layout;
    layout.reinit(solution);
    layout.reinit(committed);
    layout.reinit(system.rhs);
    relevant_u.reinit(layout.owned[0], relevant, communicator);
    for (Vector *v :
         {&internal, &external, &contact_force, &reaction, &released, &drag, &out_of_balance, &committed_applied})
      v->reinit(layout.owned[0], communicator);

    length_scale = 0.;
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      const auto ends = bodies.bounding_box(b).get_boundary_points();
      length_scale    = std::max(length_scale, 1e-6 * ends.first.distance(ends.second));
    }
    for (Vector *v : {&u_geometry, &u_before_geometry})
      v->reinit(layout.owned[0], communicator);
    committed_site_force.assign(surfaces->n_sites(), Vector3());
    committed_site_jump.assign(surfaces->n_sites(), Vector3());
    gather_state();
  }

  /// Young's modulus of the softer side of each pair.
  std::vector<double> ContactProblem::Implementation::pair_stiffness() const
  {
    std::vector<double> stiffness;
    for (const auto &pair : parameters.contact_pairs)
    {
      stiffness.push_back(materials[pair.slave.body - 1]->youngs_modulus());
      if (!pair.has_rigid_master())
        stiffness.back() = std::min(stiffness.back(), materials[pair.master.body - 1]->youngs_modulus());
    }
    return stiffness;
  }

  /// What the solution on the mesh as it is needs beyond that.
  void ContactProblem::Implementation::begin_on_mesh()
  {
    solid->make_sparsity(system.bulk);
    linear_solver_parameters      = parameters.linear_solver;
    linear_solver_parameters.type = chosen_solver(parameters, dof_handler.n_dofs());
    linear_solver =
        make_linear_solver(linear_solver_parameters, surfaces->layout(), OwnedNodes(dof_handler, *mapping).X);
    linear_solver->set_profile(&profile);
    direct_solver.reset();
    if (!parameters.output.write_vtu)
      return;
    const VtuOutput::Series series = vtu ? vtu->series() : VtuOutput::Series();
    vtu = std::make_unique<VtuOutput>(parameters.output.results_folder, bodies, dof_handler, *mapping, *solid);
    if (!series.empty())
      vtu->continue_from(series);
  }

  void ContactProblem::Implementation::update_results()
  {
    fields = Nodus::contact_fields(
        parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state, residual);
    whole_fields.clear();
    resultants = Nodus::contact_resultants(
        parameters.contact_pairs, *surfaces, pairing, jump, weights, *status, state, residual);
    reactions.clear();
    for (const auto &region : boundary_conditions->reaction_regions())
    {
      Vector3 force;
      for (unsigned int c = 0; c < dim; ++c)
        for (const DoFIndex i : region.dofs[c])
          force[c] += internal(i) - external(i) + contact_force(i);
      for (unsigned int c = 0; c < dim; ++c)
        force[c] = dealii::Utilities::MPI::sum(force[c], communicator);
      reactions.emplace_back(region.name, force);
    }
    rigid_motions.clear();
    for (unsigned int b = 0; b < rigid_bodies->size(); ++b)
    {
      const RigidBodies::Components &applied = rigid_applied[b];
      rigid_motions.push_back({rigid_bodies->name(b),
                               rigid_bodies->translation(b),
                               rigid_bodies->rotation(b),
                               Vector3({applied[0], applied[1], applied[2]}),
                               Vector3({applied[3], applied[4], applied[5]})});
    }
  }

  void ContactProblem::Implementation::write(const unsigned int increment, const bool last)
  {
    std::vector<Tables::Reaction> table;
    for (const auto &[name, force] : reactions)
      table.push_back({name, force});
    tables->add(increment, time, resultants, table, rigid_motions, energies, counts);
    const unsigned int interval = parameters.output.vtu_interval;
    if (vtu && (last || (interval > 0 && increment % interval == 0)))
    {
      relevant_u = committed.block(0);
      vtu->write(increment, time, relevant_u, fields);
    }
  }

  /// What the run starts from, as increment 0. The first increment pairs anew, as if this had not been.
  void ContactProblem::Implementation::write_initial_state()
  {
    if (!vtu || parameters.output.vtu_interval == 0)
      return;
    pair_surfaces();
    const auto timer = profile.time(Phase::output);
    state.prescribed.assign(state.x.size(), Vector3());
    residual = contact->assemble(state, system);
    fields   = Nodus::contact_fields(
        parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state, residual);
    relevant_u = solution.block(0);
    vtu->write(0, 0., relevant_u, fields);
    fields.clear();
    paired_before = false;
  }

  void ContactProblem::Implementation::summary()
  {
    std::ostringstream text;
    text << bodies.size() << (bodies.size() == 1 ? " body, " : " bodies, ")
         << bodies.triangulation().n_global_active_cells() << " cells, " << dof_handler.n_dofs()
         << " displacement degrees of freedom (Q" << parameters.degree << "), " << surfaces->layout().n_slave_nodes
         << " slave nodes, " << dealii::Utilities::MPI::n_mpi_processes(communicator)
         << (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1 ? " process" : " processes");
    console.line((parameters.title.empty() ? "nodus" : parameters.title) + ": " + text.str());
    for (unsigned int p = 0; p < surfaces->n_pairs(); ++p)
    {
      std::ostringstream line;
      line << "  contact pair " << p + 1 << in_brackets(parameters.contact_pairs[p].name) << ": "
           << surfaces->n_faces(p, slave_side) << " slave faces on ";
      if (const auto &pair = parameters.contact_pairs[p]; pair.has_rigid_master())
        line << "a rigid " << text_of(pair.master_surface.shape)
             << (pair.has_carried_master() ? " of body " + std::to_string(pair.master.body) : "");
      else
        line << surfaces->n_faces(p, master_side) << " master faces";
      line << ", mean slave face size " << surfaces->face_size(p);
      console.line(line.str());
    }
  }

  /// Prints the times so far, and more where it was asked for. @returns what went wrong with profile.json, on rank 0.
  std::string ContactProblem::Implementation::report_profile(const bool converged)
  {
    console.line("");
    if (!detailed_profile)
    {
      console.line(profile.timing_table());
      return "";
    }
    const Profile::Report report = profile.report(dof_handler.n_dofs(), converged, communicator);
    console.line(report.table());
    if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
      return "";
    CompleteFile file(parameters.output.results_folder, "profile.json");
    report.write_json(file.stream());
    return file.finish();
  }

  void ContactProblem::Implementation::run()
  {
    {
      const auto timer = profile.time(Phase::set_up);
      if (detailed_profile)
        profile.watch_memory();
      summary();
      if (restart && !checkpoints.find())
      {
        console.line("There is no checkpoint in " + parameters.output.results_folder + ": the run begins at t = 0");
        restart = false;
      }
      if (!restart)
        refine_near_contact();
      begin_on_mesh();
      tables = std::make_unique<Tables>(parameters.output.results_folder, communicator);
      diagnosis.begin_run();
    }
    if (restart)
      read_checkpoint();
    else
      write_initial_state();
    const auto report_anyway = [&]
    {
      if (const std::string problem = report_profile(false); !problem.empty())
        console.line(problem); // why the run ends is what the caller must hear of
    };
    try
    {
      follow_load_path();
    }
    catch (const SolverFailure &)
    {
      report_anyway();
      throw;
    }
    catch (const Interrupted &)
    {
      report_anyway();
      throw;
    }
    throw_on_every_rank(report_profile(true), communicator);
    console.line("Results: " + parameters.output.results_folder);
  }

  ContactProblem::ContactProblem(const Parameters &parameters, MPI_Comm communicator, std::ostream &log)
      : implementation_(std::make_unique<Implementation>(parameters, communicator, log))
  {
  }

  ContactProblem::~ContactProblem() = default;

  void ContactProblem::run()
  {
    implementation_->run();
  }

  void ContactProblem::profile()
  {
    implementation_->detailed_profile = true;
  }

  void ContactProblem::restart()
  {
    implementation_->restart = true;
  }

  const std::vector<ContactFields> &ContactProblem::contact_fields() const
  {
    auto &p = *implementation_;
    if (p.whole_fields.empty())
      p.whole_fields = whole_surface(p.fields, p.communicator);
    return p.whole_fields;
  }

  const std::vector<ContactResultants> &ContactProblem::contact_resultants() const
  {
    return implementation_->resultants;
  }

  const std::vector<std::pair<std::string, Vector3>> &ContactProblem::reactions() const
  {
    return implementation_->reactions;
  }

  const std::vector<RigidBodyMotion> &ContactProblem::rigid_bodies() const
  {
    return implementation_->rigid_motions;
  }

  const IterationCounts &ContactProblem::iterations() const
  {
    return implementation_->counts;
  }

  void ContactProblem::on_increment(const std::function<void(unsigned int, double)> &callback)
  {
    implementation_->callback = callback;
  }

  Vector3 ContactProblem::displacement(const unsigned int body, const Point &X) const
  {
    const auto           &p              = *implementation_;
    const auto           &support_points = p.fe.base_element(0).get_unit_support_points();
    std::vector<DoFIndex> dofs(p.fe.n_dofs_per_cell());
    double                found[dim + 1] = {0., 0., 0., 0.}; // owned components and how often they were met
    dealii::IndexSet      counted(p.dof_handler.n_dofs());
    for (const auto &cell : p.dof_handler.active_cell_iterators())
      if (!cell->is_artificial() && cell->material_id() + 1 == body)
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < support_points.size(); ++i)
          if (p.mapping->transform_unit_to_real_cell(cell, support_points[i]).distance(X) < 1e-8 * cell->diameter())
            for (unsigned int c = 0; c < dim; ++c)
            {
              const DoFIndex dof = dofs[p.fe.component_to_system_index(c, i)];
              if (p.surfaces->layout().owned[0].is_element(dof) && !counted.is_element(dof))
              {
                counted.add_index(dof);
                found[c] += p.committed.block(0)(dof);
                found[dim] += 1. / dim;
              }
            }
      }
    Vector3 u;
    for (unsigned int c = 0; c < dim; ++c)
      u[c] = dealii::Utilities::MPI::sum(found[c], p.communicator);
    const double n = dealii::Utilities::MPI::sum(found[dim], p.communicator); // two where a node hangs on one like it
    if (n < 0.5)
      throw InputError("body " + std::to_string(body) + " has no node at " + coordinates(X));
    return u / std::round(n);
  }
} // namespace Nodus
