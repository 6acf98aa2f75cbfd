#include "run/model.h"
#include "base/text.h"
#include "bulk/rigid_material.h"
#include "contact/facets.h"
#include "contact/initial_overlap.h"
#include "contact/pair_scales.h"
#include "contact/second_pass.h"
#include "mesh/sides.h"
#include "parallel/throw_everywhere.h"
#include "run/state_vectors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q_cache.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Rubber on rubber has about half of it.
    constexpr double largest_usual_friction = 5.;
    /// Faces of a slave that is much stiffer, over those of its master: of 99 random cases with one such pair eight do
    /// not finish, of 797 others five (contrib/studies/robustness).
    constexpr double fine_slave = 2. / 3.;

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

    /// Size over degree of the deformable cell whose nodes are the stiffest: modulus times size. Collective.
    double stiffest_cell(const Bodies                                 &bodies,
                         const std::vector<std::unique_ptr<Material>> &materials,
                         const unsigned int                            degree,
                         const MPI_Comm                                communicator)
    {
      double size = 0., stiffness = 0.;
      for (const auto &cell : bodies.triangulation().active_cell_iterators())
        if (const Material &material = *materials[cell->material_id()];
            cell->is_locally_owned() && !material.is_rigid())
          if (const double here = std::cbrt(cell->measure()) / degree; material.youngs_modulus() * here > stiffness)
          {
            size      = here;
            stiffness = material.youngs_modulus() * here;
          }
      const double largest = dealii::Utilities::MPI::max(stiffness, communicator);
      return dealii::Utilities::MPI::max(stiffness == largest ? size : 0., communicator);
    }
  } // namespace

  Model::Model(Parameters &p, MPI_Comm comm, States &states)
      : parameters(p)
      , communicator(comm)
      , bodies(parameters.bodies,
               comm,
               refines(parameters.adaptivity),
               slaves(parameters.contact_pairs),
               parameters.degree)
      , mapping(bodies.make_mapping(parameters.degree))
      , fe(dealii::FE_Q<dim>(parameters.degree), dim)
      , dof_handler(bodies.triangulation())
      , materials(make_materials(parameters.bodies))
      , rigid_bodies(parameters.bodies,
                     parameters.boundary_conditions,
                     parameters.contact_pairs,
                     bodies,
                     states.now.rigid,
                     states.committed.rigid)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1 && !parameters.contact_pairs.empty())
      balance_contact(parameters.contact_pairs, *mapping, bodies);
    set_up_mesh(states.now);
    states.committed = states.now;
  }

  void Model::set_up_mesh(State &now)
  {
    dof_handler.distribute_dofs(fe);
    relevant            = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
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
    stabilisation = std::make_unique<ViscousStabilisation>(bodies, materials, dof_handler, *mapping);
    contact.reset(); // what it refers to is made anew
    rigid_bodies.find_nodes(dof_handler, *mapping);
    set_up_contact(now);
    now.history = solid->start();

    length_scale = 0.;
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      const auto ends = bodies.bounding_box(b).get_boundary_points();
      length_scale    = std::max(length_scale, 1e-6 * ends.first.distance(ends.second));
    }
    stiffest_cell = Nodus::stiffest_cell(bodies, materials, fe.degree, communicator);
    contact->gather(now.unknowns, now.unknowns.block(0));
  }

  /// Nothing touches, and the unknowns are zero.
  void Model::set_up_contact(State &now)
  {
    contact.reset(); // it sets the state as well
    contact = std::make_unique<ContactInterface>(parameters.contact_pairs,
                                                 stiffness(),
                                                 parameters.strategy,
                                                 bodies,
                                                 dof_handler,
                                                 *mapping,
                                                 rigid_bodies,
                                                 now.contact);
    contact->surfaces().set_fixed(boundary_conditions->homogeneous_constraints());
    refuse_coupled_contact();
    refuse_shared_sections();

    const BlockLayout &layout = contact->surfaces().layout();
    layout.reinit(now.unknowns);
    now.reaction.reinit(layout.owned[0], communicator);
    now.applied.reinit(layout.owned[0], communicator);
    now.motion.reinit(layout.owned[0], communicator);
  }

  Parameters Model::with_room(Parameters parameters)
  {
    parameters.contact_pairs.reserve(2 * parameters.contact_pairs.size());
    return parameters;
  }

  void Model::add_second_passes(const std::vector<std::pair<unsigned int, double>> &passes, States &states)
  {
    const KeptState before(states.committed, *contact);
    for (const auto &[pair, clearance] : passes)
    {
      AssertThrow(parameters.contact_pairs.size() < parameters.contact_pairs.capacity(), dealii::ExcInternalError());
      parameters.contact_pairs.push_back(second_pass(parameters.contact_pairs, pair, clearance));
    }
    states.now = states.committed;
    set_up_contact(states.now);
    before.restore(*contact, states.now);
    states.committed = states.now;
    roll_back(states);
  }

  /// Contact does not know how coupled faces move.
  void Model::refuse_coupled_contact() const
  {
    const ContactSurfaces &surfaces = contact->surfaces();
    if (!rigid_bodies.has_faces() || surfaces.n_pairs() == 0)
      return;
    Vector coupled(surfaces.layout().owned[0], communicator);
    for (const DoFIndex dof : rigid_bodies.coupled())
      coupled(dof) = 1.;
    coupled.compress(dealii::VectorOperation::insert);
    std::vector<Vector3> at_nodes;
    surfaces.gather(coupled, at_nodes);
    std::string error;
    for (unsigned int n = 0; n < at_nodes.size() && error.empty(); ++n)
      if (at_nodes[n] != Vector3())
        error = "the node at " + coordinates(surfaces.nodes()[n].X) +
                " of a contact surface belongs to a face whose rigid motion is in part 'Free'; leave a row of faces "
                "between the two ('Slave where', 'Master where'), or prescribe that motion";
    throw_everywhere<InputError>(error, communicator);
  }

  /// Contact takes the slave sides of sections back along the axes of the bolts: no other surface goes with them.
  void Model::refuse_shared_sections() const
  {
    const ContactSurfaces &surfaces = contact->surfaces();
    const auto             sections = rigid_bodies.sections();
    constexpr unsigned int none     = dealii::numbers::invalid_unsigned_int;
    if (std::all_of(sections.begin(), sections.end(), [](const unsigned int section) { return section == none; }))
      return;
    Vector number(surfaces.layout().owned[0], communicator); // of the pair, from 1, that nodes are on the slave side of
    for (unsigned int n = 0; n < surfaces.nodes().size(); ++n)
      if (const DoFIndex dof = surfaces.nodes()[n].dofs[0];
          surfaces.section_of_node(n) != none && surfaces.layout().owned[0].is_element(dof))
        number(dof) = rigid_bodies.pair(surfaces.section_of_node(n)) + 1.;
    number.compress(dealii::VectorOperation::insert);
    std::vector<Vector3> at_nodes;
    surfaces.gather(number, at_nodes);
    std::string error;
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
      for (const SurfaceSide side : {slave_side, master_side})
        for (const SurfaceFace &face : side == slave_side ? surfaces.slave_faces(p) : surfaces.master_faces(p))
          for (const unsigned int n : face.nodes)
            if (const double of = at_nodes[n][0]; of != 0. && !(side == slave_side && of == p + 1.) && error.empty())
              error = "the node at " + coordinates(surfaces.nodes()[n].X) + " of " +
                      pair_label(parameters.contact_pairs, p) + " is on the slave side of the section of " +
                      pair_label(parameters.contact_pairs, static_cast<unsigned int>(of) - 1) +
                      ", which a preload moves; leave a row of faces between the two ('Slave where', 'Master where'), "
                      "or exchange the two sides of the section";
    throw_everywhere<InputError>(error, communicator);
  }

  void Model::set_conditions(const double t)
  {
    if (boundary_conditions->set_time(t))
      contact->surfaces().set_fixed(boundary_conditions->homogeneous_constraints());
    solid->set_time(t);
    rigid_bodies.set_time(t);
  }

  void Model::look_ahead(const std::vector<double> &times)
  {
    const ContactSurfaces &surfaces = contact->surfaces();
    for (const double t : times)
    {
      set_conditions(t);
      for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
        if (const RigidSurface *const master = surfaces.rigid_master(p))
          master->check_motion(t);
    }
    if (!times.empty())
      set_conditions(times.front());
  }

  std::vector<std::string> Model::begin_contact(States &states, const double t)
  {
    const auto &pairs = parameters.contact_pairs;
    if (t > 0. && std::none_of(pairs.begin(),
                               pairs.end(),
                               [t](const ActiveTime &pair) { return pair.active_from == t || pair.active_until == t; }))
      return {};
    State &now = states.now;
    Vector ended(now.reaction); // its map
    ended                             = 0.;
    std::vector<std::string> warnings = contact->begin(now.unknowns, t, ended);
    now.reaction -= ended;
    now.applied -= ended;
    dealii::MappingQCache<dim> deformed(fe.degree);
    if (t > 0.)
      deformed.initialize(*mapping, dof_handler, with_ghosts(now.unknowns.block(0)), true);
    const dealii::Mapping<dim> &as_it_is = t > 0. ? deformed : *mapping;
    refuse_hidden_overlap(pairs, contact->surfaces(), bodies, as_it_is, now.unknowns.block(0), t);
    if (t == 0.)
    {
      const std::vector<double> moduli = stiffness();
      for (unsigned int p = 0; p < pairs.size(); ++p)
      {
        if (pairs[p].friction_coefficient > largest_usual_friction)
          warnings.push_back(text(pair_label(pairs, p),
                                  ": 'Friction coefficient' is ",
                                  pairs[p].friction_coefficient,
                                  "; it is a ratio of forces, not per cent, and of hard dry bodies rarely above 1"));
        const ContactSurfaces &surfaces = contact->surfaces();
        const double           ratio    = slave_over_master(parameters, p, moduli);
        if (ratio >= much_stiffer && contact->status().has_friction(p) &&
            surfaces.face_size(p) <= fine_slave * surfaces.master_face_size(p))
          warnings.push_back(text(pair_label(pairs, p),
                                  ": the slave is ",
                                  ratio,
                                  " times as stiff as the master, and finer; with the softer side as slave runs with "
                                  "friction are faster and fail less often"));
      }
      for (const std::string &sentence :
           sides_that_stay_facets(parameters, contact->surfaces(), *contact->geometry(), bodies, *mapping))
        warnings.push_back(sentence);
    }
    states.committed = now;
    return warnings;
  }

  std::vector<double> Model::resolved_interference(const double t) const
  {
    const std::vector<double> &ends = parameters.load_stepping.interval_ends;
    std::vector<double>        parts;
    for (const ContactPairParameters &pair : parameters.contact_pairs)
    {
      const double from = pair.active_from;
      const auto   end  = std::upper_bound(ends.begin(), ends.end(), from); // of the first interval that it acts in
      parts.push_back(t > from ? std::min(1., (t - from) / (*end - from)) : 0.);
    }
    return parts;
  }

  void Model::impose(const Increment &increment)
  {
    set_conditions(increment.end);
    contact->begin_increment(increment.begin, increment.end, resolved_interference(increment.end));
    for (auto &material : materials)
      material->set_step(increment.duration());
    stabilisation->set_increment(
        increment.viscosity, increment.begin, increment.end, increment.interval_begin, increment.interval_end);
  }

  void Model::roll_back(States &states)
  {
    states.now = states.committed;
    contact->resume(states.now.unknowns, states.now.unknowns.block(0));
    solid->start_from(states.now.history);
  }

  std::vector<double> Model::stiffness() const
  {
    std::vector<double> of_bodies;
    for (const auto &material : materials)
      of_bodies.push_back(material->youngs_modulus());
    return of_bodies;
  }

  Vector Model::with_ghosts(const Vector &v) const
  {
    Vector ghosted(contact->surfaces().layout().owned[0], relevant, communicator);
    ghosted = v;
    return ghosted;
  }

  std::vector<std::string> Model::summary() const
  {
    const ContactSurfaces   &surfaces = contact->surfaces();
    std::vector<std::string> lines;
    std::ostringstream       text;
    text << (parameters.title.empty() ? "nodus" : parameters.title) << ": " << bodies.size()
         << (bodies.size() == 1 ? " body, " : " bodies, ") << bodies.triangulation().n_global_active_cells()
         << " cells, " << dof_handler.n_dofs() << " displacement degrees of freedom (Q" << parameters.degree << "), "
         << surfaces.layout().n_slave_nodes << " slave nodes, " << dealii::Utilities::MPI::n_mpi_processes(communicator)
         << (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1 ? " process" : " processes");
    lines.push_back(text.str());
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      std::ostringstream line;
      line << "  contact pair " << p + 1 << in_brackets(parameters.contact_pairs[p].name) << ": "
           << surfaces.n_faces(p, slave_side) << " slave faces on ";
      if (const auto &pair = parameters.contact_pairs[p]; pair.has_rigid_master())
        line << "a rigid " << surfaces.rigid_master(p)->describe()
             << (pair.has_carried_master() ? " of " + pair.master.bodies_text() : "");
      else
        line << surfaces.n_faces(p, master_side) << " master faces";
      line << ", mean slave face size " << surfaces.face_size(p);
      if (const unsigned int section = surfaces.section(p); section != dealii::numbers::invalid_unsigned_int)
        line << ", section of a bolt along " << coordinates(Point(surfaces.axis(section)));
      lines.push_back(line.str());
    }
    return lines;
  }
} // namespace Nodus
