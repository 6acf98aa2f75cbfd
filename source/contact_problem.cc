#include <nodus/bulk/boundary_conditions.h>
#include <nodus/bulk/material.h>
#include <nodus/bulk/solid_assembler.h>
#include <nodus/contact/contact_assembler.h>
#include <nodus/contact/tractions.h>
#include <nodus/contact_problem.h>
#include <nodus/mesh/bodies.h>
#include <nodus/output/console.h>
#include <nodus/output/tables.h>
#include <nodus/output/vtu.h>
#include <nodus/solve/fixed_point_loop.h>
#include <nodus/solve/linear_solver.h>
#include <nodus/solve/newton.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    std::vector<std::unique_ptr<Material>> make_materials(const std::vector<BodyParameters> &bodies)
    {
      std::vector<std::unique_ptr<Material>> materials;
      for (const auto &body : bodies)
        materials.push_back(make_material(body.material));
      return materials;
    }

    /// rho_n = factor E/h: the stiffness of a layer of slave material one face deep.
    std::vector<double> normal_augmentations(const Parameters                             &parameters,
                                             const ContactSurfaces                        &surfaces,
                                             const std::vector<std::unique_ptr<Material>> &materials)
    {
      std::vector<double> rho;
      for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
        rho.push_back(parameters.contact_pairs[p].normal_augmentation_factor *
                      materials[surfaces.slave_body(p)]->youngs_modulus() / surfaces.face_size(p));
      return rho;
    }

    double largest_entry(const std::vector<Vector3> &a, const std::vector<Vector3> &b)
    {
      double largest = 0.;
      for (unsigned int i = 0; i < a.size(); ++i)
        largest = std::max(largest, (a[i] - b[i]).norm());
      return largest;
    }

    std::string coordinates(const Point &X)
    {
      std::ostringstream text;
      text << "(" << X << ")";
      return text.str();
    }
  } // namespace

  struct ContactProblem::Implementation : public NewtonProblem
  {
    Implementation(const Parameters &parameters, MPI_Comm communicator, std::ostream &log);

    // The algorithm, outermost first.
    void run();
    void solve_increment();
    void pair_surfaces(bool first_of_run);
    bool geometry_converged(FixedPointLoop &loop);
    bool threshold_converged(FixedPointLoop &loop);
    bool statuses_converged(FixedPointLoop &loop);

    // Newton's view of it.
    Norms        assemble() override;
    unsigned int solve(BlockVector &correction) override;
    void         advance(double factor, const BlockVector &correction) override;

    void                gather_state();
    std::vector<double> weighted_pressure() const;
    std::string         slave_locus(unsigned int slave) const;
    std::string         unknown_locus(DoFIndex flat_index) const;
    void                commit();
    void                roll_back();
    void                write(unsigned int increment, bool last);
    void                update_results();
    void                summary();

    const Parameters parameters;
    MPI_Comm         communicator;
    Console          console;

    Bodies                                 bodies;
    dealii::MappingQ<dim>                  mapping;
    dealii::FESystem<dim>                  fe;
    dealii::DoFHandler<dim>                dof_handler;
    dealii::IndexSet                       relevant;
    std::vector<std::unique_ptr<Material>> materials;
    std::unique_ptr<BoundaryConditions>    boundary_conditions;
    std::unique_ptr<SolidAssembler>        solid;

    std::unique_ptr<ContactSurfaces>  surfaces;
    Pairing                           pairing;
    JumpOperator                      jump;
    SurfaceWeights                    weights;
    std::unique_ptr<Status>           status;
    std::unique_ptr<ContactAssembler> contact;

    std::unique_ptr<LinearSolver> linear_solver;
    LinearSystem                  system;
    BlockVector                   solution, committed; ///< (u, lambda, Lambda), now and at the start of the load step
    Vector                        relevant_u, internal, external, contact_force;
    double                        length_scale; ///< displacements are measured against this when the step moves nothing

    ContactState         state;
    ContactResidual      residual;
    std::vector<Vector3> u_start, u_geometry,
        u_before_geometry; ///< surface nodes: step start, this and the previous pairing
    bool paired_before = false;

    double          time = 0.;
    IterationCounts pass, counts; ///< where the loops stand, and totals of the increment

    std::vector<ContactFields>                   fields;
    std::vector<ContactResultants>               resultants;
    std::vector<std::pair<std::string, Vector3>> reactions;
    std::function<void(unsigned int, double)>    callback;
    std::unique_ptr<VtuOutput>                   vtu;
    std::unique_ptr<Tables>                      tables;
  };

  ContactProblem::Implementation::Implementation(const Parameters &p, MPI_Comm comm, std::ostream &log)
      : parameters(p)
      , communicator(comm)
      , console(log, dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      , bodies(parameters.bodies, comm)
      , mapping(parameters.degree)
      , fe(dealii::FE_Q<dim>(parameters.degree), dim)
      , dof_handler(bodies.triangulation())
      , materials(make_materials(parameters.bodies))
  {
    const auto timer = console.time("set-up");
    dof_handler.distribute_dofs(fe);
    dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
    boundary_conditions = std::make_unique<BoundaryConditions>(
        parameters.boundary_conditions, bodies, dof_handler, mapping, parameters.load_stepping.interval_ends.back());
    solid    = std::make_unique<SolidAssembler>(dof_handler, mapping, materials, boundary_conditions->loads());
    surfaces = std::make_unique<ContactSurfaces>(parameters.contact_pairs, bodies, dof_handler, mapping);
    surfaces->set_fixed(boundary_conditions->homogeneous_constraints());
    status = std::make_unique<Status>(
        parameters.contact_pairs, *surfaces, normal_augmentations(parameters, *surfaces, materials));
    contact = std::make_unique<ContactAssembler>(*surfaces, pairing, jump, weights, *status);

    const BlockLayout &layout = surfaces->layout();
    system.layout             = &layout;
    layout.reinit(solution);
    layout.reinit(committed);
    layout.reinit(system.rhs);
    relevant_u.reinit(layout.owned[0], relevant, communicator);
    for (Vector *v : {&internal, &external, &contact_force})
      v->reinit(layout.owned[0], communicator);

    length_scale = 0.;
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      const auto ends = bodies.bounding_box(b).get_boundary_points();
      length_scale    = std::max(length_scale, 1e-6 * ends.first.distance(ends.second));
    }
    u_start.resize(surfaces->nodes().size());
    gather_state();
  }

  void ContactProblem::Implementation::gather_state()
  {
    std::vector<Vector3> u;
    surfaces->gather(solution.block(0), u);
    state.x = surfaces->positions(u);
    state.increment.resize(u.size());
    state.prescribed.resize(u.size());
    for (unsigned int i = 0; i < u.size(); ++i)
      state.increment[i] = u[i] - u_start[i];

    // Multipliers live with their owners; the nodal arrays are replicated.
    const unsigned int  n     = surfaces->slave_nodes().size();
    const auto          owned = surfaces->owned_slave_nodes();
    std::vector<double> all(3 * n, 0.);
    for (unsigned int k = owned.first; k < owned.second; ++k)
    {
      all[3 * k]     = solution.block(1)(k);
      all[3 * k + 1] = solution.block(2)(2 * k);
      all[3 * k + 2] = solution.block(2)(2 * k + 1);
    }
    dealii::Utilities::MPI::sum(all, communicator, all);
    state.lambda.resize(n);
    state.Lambda.resize(n);
    for (unsigned int k = 0; k < n; ++k)
    {
      state.lambda[k] = all[3 * k];
      state.Lambda[k] = {{all[3 * k + 1], all[3 * k + 2]}};
    }
  }

  NewtonProblem::Norms ContactProblem::Implementation::assemble()
  {
    relevant_u              = solution.block(0);
    const auto &constraints = boundary_conditions->increment_constraints(relevant_u);
    {
      const auto timer = console.time("bulk assembly");
      solid->tangent(relevant_u, time, constraints, system.bulk, system.rhs.block(0), internal, external);
    }

    const auto timer = console.time("contact assembly");
    gather_state();
    Norms  norms;
    Vector prescribed(surfaces->layout().owned[0], communicator);
    for (const auto i : surfaces->layout().owned[0])
      if (constraints.is_constrained(i))
        prescribed(i) = constraints.get_inhomogeneity(i);
    prescribed.compress(dealii::VectorOperation::insert);
    surfaces->gather(prescribed, state.prescribed);

    residual      = contact->assemble(state, system);
    contact_force = 0.;
    contact->add_forces(residual, contact_force);

    Vector moved(solution.block(0));
    moved -= committed.block(0);
    const double length = std::max(moved.linfty_norm(), length_scale);
    const double scale  = std::max({internal.linfty_norm(), external.linfty_norm(), contact_force.linfty_norm()});
    double       force  = 0.;
    for (const auto i : surfaces->layout().owned[0])
      if (!constraints.is_constrained(i))
        force = std::max(force, std::abs(internal(i) - external(i) + contact_force(i)));
    force            = dealii::Utilities::MPI::max(force, communicator);
    norms.force      = scale > 0. ? force / scale : 0.;
    norms.contact    = contact->norm(residual, length);
    norms.prescribed = prescribed.linfty_norm() / length;
    return norms;
  }

  unsigned int ContactProblem::Implementation::solve(BlockVector &correction)
  {
    const auto                 timer  = console.time("linear solver");
    const LinearSolver::Report report = linear_solver->solve(system, correction);
    if (!report.null_pivots.empty())
      throw SolverFailure("the system is singular (" + std::to_string(report.null_pivots.size()) +
                          " null pivots), first at " + unknown_locus(report.null_pivots.front()));
    // The solver leaves prescribed components alone: they take what the constraints still ask for.
    boundary_conditions->increment_constraints(relevant_u).distribute(correction.block(0));
    return report.iterations;
  }

  void ContactProblem::Implementation::advance(const double factor, const BlockVector &correction)
  {
    solution.add(factor, correction);
  }

  /// Freezes the geometry: projections, frames, jump operator and surface weights at the current positions.
  void ContactProblem::Implementation::pair_surfaces(const bool first_of_run)
  {
    const auto    timer  = console.time("pairing");
    const Pairing before = pairing;
    gather_state();
    u_before_geometry = u_geometry;
    surfaces->gather(solution.block(0), u_geometry);

    pairing.project(parameters.contact_pairs, *surfaces, state.x);
    jump.build_nodal(*surfaces, pairing);
    weights.compute(parameters.contact_pairs,
                    *surfaces,
                    state.x,
                    surfaces->positions(std::vector<Vector3>(surfaces->nodes().size())));

    if (first_of_run)
    {
      std::vector<double> distance;
      for (unsigned int k = 0; k < pairing.size(); ++k)
        distance.push_back(contact->distance(state, k));
      status->initialize(pairing, distance);
      return;
    }
    status->inherit(pairing);

    // Lambda keeps its direction in space and its length in the new tangent planes; nodes without partner lose all.
    const auto owned = surfaces->owned_slave_nodes();
    for (unsigned int k = owned.first; k < owned.second; ++k)
    {
      Vector3 Lambda;
      for (unsigned int i = 0; i < 2; ++i)
        Lambda += state.Lambda[k][i] * before[k].tangent[i];
      double component[2] = {0., 0.};
      for (unsigned int i = 0; i < 2; ++i)
        if (pairing[k].found && pairing[k].tangent_free[i])
          component[i] = Lambda * pairing[k].tangent[i];
      const double norm = std::hypot(component[0], component[1]);
      for (unsigned int i = 0; i < 2; ++i)
        solution.block(2)(2 * k + i) = norm > 0. ? component[i] * Lambda.norm() / norm : 0.;
      solution.block(1)(k) = pairing[k].found ? state.lambda[k] : 0.;
    }
    solution.block(1).compress(dealii::VectorOperation::insert);
    solution.block(2).compress(dealii::VectorOperation::insert);
    gather_state();
  }

  std::vector<double> ContactProblem::Implementation::weighted_pressure() const
  {
    std::vector<double> filtered(state.lambda.size());
    for (unsigned int k = 0; k < filtered.size(); ++k)
      filtered[k] = status->contact(k) ? state.lambda[k] : 0.;
    return weights.weighted(filtered);
  }

  bool ContactProblem::Implementation::statuses_converged(FixedPointLoop &loop)
  {
    const unsigned int n = surfaces->slave_nodes().size();
    StatusInput        input;
    input.pressure = weighted_pressure();
    input.Lambda   = state.Lambda;
    if (status->has_friction())
      for (unsigned int i = 0; i < 2; ++i)
      {
        // the weighted friction traction over the weighted threshold, as for the pressure
        std::vector<double> traction(n);
        for (unsigned int k = 0; k < n; ++k)
          traction[k] = status->friction(k) ? state.Lambda[k][i] : 0.;
        traction = weights.weighted(traction);
        for (unsigned int k = 0; k < n; ++k)
          input.Lambda[k][i] = traction[k];
      }
    for (unsigned int k = 0; k < n; ++k)
    {
      if (parameters.contact_pairs[surfaces->slave_nodes()[k].pair].status_test ==
          ContactPairParameters::StatusTest::raw)
      {
        input.pressure[k] = status->contact(k) ? state.lambda[k] : 0.;
        input.Lambda[k]   = state.Lambda[k];
      }
      // without partner there is no distance: keep the test on the open side
      input.distance.push_back(pairing[k].found ? contact->distance(state, k) : 0.);
      input.slip.push_back(contact->slip(state, k));
    }
    const Status::Update update = status->update(input);
    ++counts.status;
    if (update.changes > 0)
    {
      console.remark(std::to_string(update.changes) + " statuses changed, first at " +
                     slave_locus(update.slaves.front()));
      if (update.period > 0)
      {
        std::string nodes;
        for (unsigned int i = 0; i < std::min<std::size_t>(3, update.slaves.size()); ++i)
          nodes += (i > 0 ? "; " : "") + slave_locus(update.slaves[i]);
        throw SolverFailure("the status loop cycles with period " + std::to_string(update.period) + ", " +
                            std::to_string(update.changes) + " nodes change back and forth: " + nodes);
      }
    }
    return loop.finished(update.changes, update.changes > 0 ? slave_locus(update.slaves.front()) : "");
  }

  bool ContactProblem::Implementation::threshold_converged(FixedPointLoop &loop)
  {
    ++counts.threshold;
    if (!status->has_friction())
      return loop.finished(0., "");
    const Status::Change change = status->threshold_change(weighted_pressure());
    std::ostringstream   text;
    text << "threshold changes by " << change.value << ", most at " << slave_locus(change.slave);
    console.remark(text.str());
    return loop.finished(change.value, slave_locus(change.slave));
  }

  bool ContactProblem::Implementation::geometry_converged(FixedPointLoop &loop)
  {
    ++counts.geometry;
    std::vector<Vector3> u;
    surfaces->gather(solution.block(0), u);
    const double change = largest_entry(u, u_geometry);
    const double step   = largest_entry(u_geometry, u_start);
    const double value  = change <= 1e-12 * length_scale ? 0. : step > 0. ? change / step : 1.;

    unsigned int worst = 0;
    for (unsigned int i = 1; i < u.size(); ++i)
      if ((u[i] - u_geometry[i]).norm() > (u[worst] - u_geometry[worst]).norm())
        worst = i;
    std::ostringstream text;
    text << "geometry changes by " << value << " of the step, most at "
         << (u.empty() ? "" : coordinates(surfaces->nodes()[worst].X));
    console.remark(text.str());

    // The solution of two passes ago again, while it differs from that of the last one: a 2-cycle.
    if (loop.counter() >= 3 && value > parameters.geometry_loop.tolerance &&
        largest_entry(u, u_before_geometry) <= 1e-6 * change)
      throw SolverFailure("the geometry loop cycles with period 2, criterion " + std::to_string(value) + ", worst at " +
                          coordinates(surfaces->nodes()[worst].X) +
                          ": a slave node crosses an edge of the faceted master and back; try 'Normal = averaged' or "
                          "smaller increments");
    return loop.finished(value, u.empty() ? "" : coordinates(surfaces->nodes()[worst].X));
  }

  /// The three nested fixed-point loops around Newton (theory section 6).
  void ContactProblem::Implementation::solve_increment()
  {
    counts = IterationCounts();
    surfaces->gather(committed.block(0), u_start);
    const Newton newton(parameters.newton);

    FixedPointLoop geometry("geometry", parameters.geometry_loop);
    do
    {
      pair_surfaces(!paired_before);
      paired_before = true;

      FixedPointLoop threshold("threshold", parameters.threshold_loop);
      do
      {
        status->freeze_threshold(weighted_pressure());
        status->begin_loop();

        FixedPointLoop statuses("status", parameters.status_loop);
        do
        {
          pass.geometry  = geometry.counter() + 1;
          pass.threshold = threshold.counter() + 1;
          pass.status    = statuses.counter() + 1;
          const auto report =
              newton.solve(*this,
                           [&](const unsigned int iteration, const Norms &norms, const unsigned int krylov)
                           { console.newton_iteration(pass, iteration, norms, krylov); });
          counts.newton += report.iterations;
          counts.krylov += report.krylov_iterations;
        } while (!statuses_converged(statuses));
      } while (!threshold_converged(threshold));
    } while (!geometry_converged(geometry));
  }

  std::string ContactProblem::Implementation::slave_locus(const unsigned int slave) const
  {
    if (slave >= surfaces->slave_nodes().size())
      return "";
    const SlaveNode &s    = surfaces->slave_nodes()[slave];
    const auto      &name = parameters.contact_pairs[s.pair].name;
    return "slave node " + coordinates(surfaces->nodes()[s.node].X) + " of contact pair " + std::to_string(s.pair + 1) +
           (name.empty() ? "" : " ('" + name + "')");
  }

  std::string ContactProblem::Implementation::unknown_locus(const DoFIndex flat_index) const
  {
    const BlockLayout &layout = surfaces->layout();
    if (flat_index >= layout.lambda(0))
    {
      const bool         pressure = flat_index < layout.Lambda(0, 0);
      const unsigned int k        = pressure ? flat_index - layout.lambda(0) : (flat_index - layout.Lambda(0, 0)) / 2;
      return (pressure ? "the contact multiplier of " : "the friction multiplier of ") + slave_locus(k) +
             ": this constraint repeats another one (over-constraint)";
    }
    std::map<DoFIndex, Point> points;
    dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler, points);
    const auto  owner = points.find(flat_index);
    std::string here =
        owner == points.end() || !surfaces->layout().owned[0].is_element(flat_index) ? "" : coordinates(owner->second);
    for (const auto &part : dealii::Utilities::MPI::all_gather(communicator, here))
      if (!part.empty())
        here = part;
    return "the displacement of node " + here +
           ": its body is free to move; hold it with a boundary condition, or close the contact first ('Initial status "
           "= closed')";
  }

  void ContactProblem::Implementation::commit()
  {
    std::vector<std::array<double, 2>> slip;
    for (unsigned int k = 0; k < surfaces->slave_nodes().size(); ++k)
      slip.push_back(contact->slip(state, k));
    status->commit(slip);
    committed = solution;
  }

  void ContactProblem::Implementation::roll_back()
  {
    solution = committed;
    status->roll_back();
  }

  void ContactProblem::Implementation::update_results()
  {
    fields = Nodus::contact_fields(
        parameters.contact_pairs, *surfaces, pairing, weights, *status, *contact, state, residual);
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
  }

  void ContactProblem::Implementation::write(const unsigned int increment, const bool last)
  {
    const auto                    timer = console.time("output");
    std::vector<Tables::Reaction> table;
    for (const auto &[name, force] : reactions)
      table.push_back({name, force});
    tables->add(increment, time, resultants, table, counts);
    const unsigned int interval = parameters.output.vtu_interval;
    if (last || (interval > 0 && increment % interval == 0))
    {
      relevant_u = committed.block(0);
      vtu->write(increment, time, relevant_u, fields);
    }
  }

  void ContactProblem::Implementation::summary()
  {
    std::ostringstream text;
    text << bodies.size() << (bodies.size() == 1 ? " body, " : " bodies, ")
         << bodies.triangulation().n_global_active_cells() << " cells, " << dof_handler.n_dofs()
         << " displacement degrees of freedom (Q" << parameters.degree << "), " << surfaces->slave_nodes().size()
         << " slave nodes, " << dealii::Utilities::MPI::n_mpi_processes(communicator)
         << (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1 ? " process" : " processes");
    console.line((parameters.title.empty() ? "nodus" : parameters.title) + ": " + text.str());
    for (unsigned int p = 0; p < surfaces->n_pairs(); ++p)
    {
      std::ostringstream line;
      line << "  contact pair " << p + 1
           << (parameters.contact_pairs[p].name.empty() ? "" : " (" + parameters.contact_pairs[p].name + ")") << ": "
           << surfaces->slave_faces(p).size() << " slave faces on " << surfaces->master_faces(p).size()
           << " master faces, mean slave face size " << surfaces->face_size(p);
      console.line(line.str());
    }
  }

  void ContactProblem::Implementation::run()
  {
    summary();
    system.bulk.clear();
    solid->make_sparsity(boundary_conditions->homogeneous_constraints(), system.bulk);
    RigidBodyData rigid;
    {
      std::map<DoFIndex, Point> points;
      dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler, points);
      std::map<DoFIndex, std::pair<char, char>> component_and_body;
      std::vector<DoFIndex>                     dofs(fe.n_dofs_per_cell());
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
        {
          cell->get_dof_indices(dofs);
          for (unsigned int i = 0; i < dofs.size(); ++i)
            component_and_body[dofs[i]] = {static_cast<char>(fe.system_to_component_index(i).first),
                                           static_cast<char>(cell->material_id())};
        }
      for (const auto i : surfaces->layout().owned[0])
      {
        rigid.support_points.push_back(points[i]);
        rigid.component.push_back(component_and_body[i].first);
        rigid.body.push_back(component_and_body[i].second);
      }
    }
    linear_solver = make_linear_solver(parameters.linear_solver, surfaces->layout(), rigid);
    vtu    = std::make_unique<VtuOutput>(parameters.output.results_folder, bodies, dof_handler, mapping, materials);
    tables = std::make_unique<Tables>(parameters.output.results_folder, communicator);

    std::vector<double> times;
    double              start = 0.;
    const auto         &path  = parameters.load_stepping;
    for (unsigned int i = 0; i < path.interval_ends.size(); ++i)
    {
      for (unsigned int n = 1; n <= path.increments[i]; ++n)
        times.push_back(start + (path.interval_ends[i] - start) * n / path.increments[i]);
      start = path.interval_ends[i];
    }

    for (unsigned int increment = 1; increment <= times.size(); ++increment)
    {
      const double before = time;
      time                = times[increment - 1];
      console.begin_increment(increment, times.size(), time);
      boundary_conditions->set_time(time);
      try
      {
        solve_increment();
      }
      catch (const SolverFailure &failure)
      {
        roll_back();
        time = before;
        if (increment > 1)
        {
          relevant_u = committed.block(0);
          vtu->write(increment - 1, before, relevant_u, fields);
        }
        console.timing_table();
        std::ostringstream message;
        message << "increment " << increment << " (t = " << times[increment - 1] << "), geometry pass " << pass.geometry
                << ", threshold pass " << pass.threshold << ", status pass " << pass.status << ": " << failure.what()
                << ". The last converged state is t = " << before << (increment > 1 ? "" : " (nothing was written)");
        throw SolverFailure(message.str());
      }
      commit();
      update_results();
      write(increment, increment == times.size());
      console.end_increment(counts, resultants);
      if (callback)
        callback(increment, time);
    }
    console.timing_table();
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

  void ContactProblem::validate()
  {
    auto &p = *implementation_;
    p.summary();
    p.pair_surfaces(true);
    for (unsigned int pair = 0; pair < p.surfaces->n_pairs(); ++pair)
    {
      unsigned int n = 0, found = 0, closed = 0;
      double       smallest = std::numeric_limits<double>::max(), largest = -smallest;
      for (unsigned int k = 0; k < p.pairing.size(); ++k)
        if (p.surfaces->slave_nodes()[k].pair == pair)
        {
          ++n;
          closed += p.status->contact(k);
          if (!p.pairing[k].found)
            continue;
          ++found;
          const double gap = -p.contact->distance(p.state, k);
          smallest         = std::min(smallest, gap);
          largest          = std::max(largest, gap);
        }
      std::ostringstream text;
      text << "  contact pair " << pair + 1 << ": " << found << " of " << n << " slave nodes find a master point";
      if (found > 0)
        text << ", gap " << smallest << " to " << largest << ", " << closed << " start closed";
      p.console.line(text.str());
    }
  }

  const std::vector<ContactFields> &ContactProblem::contact_fields() const
  {
    return implementation_->fields;
  }

  const std::vector<ContactResultants> &ContactProblem::contact_resultants() const
  {
    return implementation_->resultants;
  }

  const std::vector<std::pair<std::string, Vector3>> &ContactProblem::reactions() const
  {
    return implementation_->reactions;
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
          if (p.mapping.transform_unit_to_real_cell(cell, support_points[i]).distance(X) < 1e-8 * cell->diameter())
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
    if (dealii::Utilities::MPI::sum(found[dim], p.communicator) < 0.5)
      throw InputError("body " + std::to_string(body) + " has no node at " + coordinates(X));
    return u;
  }
} // namespace Nodus
