#include "parameters/body_names.h"
#include "parameters/general_contact.h"
#include "parameters/named_ids.h"
#include "parameters/parameter_file.h"
#include "parameters/parameter_keys.h"

// The keys of a contact pair, in the order of the reference, and what they share with bodies and boundary conditions.

namespace Nodus
{
  namespace
  {
    using namespace ParameterKeys;

    const Names<MasterSurfaceParameters::Shape> shape_names = {
        {MasterSurfaceParameters::Shape::mesh, "mesh"},
        {MasterSurfaceParameters::Shape::plane, "plane"},
        {MasterSurfaceParameters::Shape::sphere, "sphere"},
        {MasterSurfaceParameters::Shape::cylinder, "cylinder"},
        {MasterSurfaceParameters::Shape::paraboloid, "paraboloid"},
        {MasterSurfaceParameters::Shape::triangles, "triangles"}};

    const Names<ContactPairParameters::Scheme> scheme_names = {
        {ContactPairParameters::Scheme::nodal, "nodal"},
        {ContactPairParameters::Scheme::integration_point, "integration point"},
        {ContactPairParameters::Scheme::averaged, "averaged"}};

    const Names<ContactPairParameters::Integration> integration_names = {
        {ContactPairParameters::Integration::face, "face"}, {ContactPairParameters::Integration::segment, "segment"}};

    const Names<ContactPairParameters::QuadratureRule> rule_names = {
        {ContactPairParameters::QuadratureRule::gauss, "Gauss"},
        {ContactPairParameters::QuadratureRule::simpson, "Simpson"},
        {ContactPairParameters::QuadratureRule::newton_cotes, "Newton-Cotes"}};

    const Names<ContactPairParameters::Surface> surface_names = {
        {ContactPairParameters::Surface::faceted, "faceted"}, {ContactPairParameters::Surface::smoothed, "smoothed"}};

    const Names<ContactPairParameters::SurfaceMeasure> surface_measure_names = {
        {ContactPairParameters::SurfaceMeasure::current, "current"},
        {ContactPairParameters::SurfaceMeasure::reference, "reference"}};

    const Names<ContactPairParameters::Weights> weights_names = {
        {ContactPairParameters::Weights::nodal_quadrature, "nodal quadrature"},
        {ContactPairParameters::Weights::dual, "dual"},
        {ContactPairParameters::Weights::consistent, "consistent"}};

    const Names<ContactPairParameters::Normal> normal_names = {
        {ContactPairParameters::Normal::master_facet, "master facet"},
        {ContactPairParameters::Normal::averaged, "averaged"},
        {ContactPairParameters::Normal::slave, "slave"}};

    const Names<ContactPairParameters::InitialStatus> initial_status_names = {
        {ContactPairParameters::InitialStatus::by_gap, "by gap"},
        {ContactPairParameters::InitialStatus::closed, "closed"},
        {ContactPairParameters::InitialStatus::open, "open"}};

    const Names<ContactPairParameters::InitialOverclosure> overclosure_names = {
        {ContactPairParameters::InitialOverclosure::resolve, "resolve in the first increment"},
        {ContactPairParameters::InitialOverclosure::adjust, "strain-free adjust"},
        {ContactPairParameters::InitialOverclosure::interference, "interference fit"}};

    const Names<ContactPairParameters::StatusTest> status_test_names = {
        {ContactPairParameters::StatusTest::weighted, "weighted"}, {ContactPairParameters::StatusTest::raw, "raw"}};
  } // namespace

  std::string text_of(const MasterSurfaceParameters::Shape shape)
  {
    return text_of(shape, shape_names);
  }

  std::string text_of(const ContactPairParameters::Scheme scheme)
  {
    return text_of(scheme, scheme_names);
  }

  std::string text_of(const ContactPairParameters::Integration integration)
  {
    return text_of(integration, integration_names);
  }

  std::string text_of(const ContactPairParameters::Surface surface)
  {
    return text_of(surface, surface_names);
  }

  /// @p prefix is "Slave ", "Master " or empty.
  void ParameterKeys::add_region(ParameterHandler  &prm,
                                 const std::string &prefix,
                                 RegionParameters  &region,
                                 const std::string &every_body,
                                 const std::string &where)
  {
    add_bodies(prm,
               prefixed(prefix, "Body"),
               region,
               "Number or Name of the body [-]" + every_body +
                   ". Several are separated by commas, e.g. 2, 3 or groove, lid.");
    add_ids(
        prm,
        prefixed(prefix, "Boundary ids"),
        region.boundary_ids,
        region.boundary_names,
        "Boundary ids of its faces [-], or names of physical surfaces of its mesh file, e.g. 1, 5 or seal_outer, 5. Of "
        "several bodies each has those of them that it has; an id of one body only is written with its number or Name, "
        "e.g. 2:5 or lid:inner. Empty: all outer faces for which 'Where' holds.");
    prm.add_parameter(prefixed(prefix, "Where"),
                      region.where,
                      "Condition that thins the faces out, or chooses them where no ids are given, on the reference "
                      "coordinates x, y, z [length] and the outward normal nx, ny, nz [-] at the centre of the face, "
                      "e.g. abs(x)<1e-9 or nz>0.9 (see meshes.md); empty: no condition. " +
                          where,
                      Patterns::Anything());
  }

  void ParameterKeys::add_expressions(ParameterHandler         &prm,
                                      const std::string        &key,
                                      std::vector<std::string> &expressions,
                                      const std::string        &documentation)
  {
    std::string default_text;
    for (const std::string &expression : expressions)
      default_text += (default_text.empty() ? "" : "; ") + expression;
    prm.declare_entry(key, default_text, anything_separated_by(";"), documentation);
    prm.add_action(key,
                   [&expressions](const std::string &text)
                   { expressions = dealii::Utilities::split_string_list(text, ';'); });
  }

  void ParameterKeys::add_active_time(ParameterHandler  &prm,
                                      ActiveTime        &time,
                                      const std::string &what,
                                      const std::string &after)
  {
    const std::string how = "one of the Interval ends";
    prm.add_parameter(
        "Active from", time.active_from, "Time after which the " + what + " acts [-]: 0 or " + how + ".", not_negative);
    prm.add_parameter("Active until",
                      time.active_until,
                      "Time until which the " + what + " acts [-]: " + how + "; 0: the end. From then on " + after +
                          " linearly in the interval after it.",
                      not_negative);
  }

  namespace
  {
    /// A rigid surface instead of a meshed master.
    void add_master_surface(ParameterHandler &prm, MasterSurfaceParameters &surface)
    {
      add_choice(
          prm,
          "Master surface",
          surface.shape,
          shape_names,
          "What the slave touches [-]: faces of a mesh, or a rigid surface without boundary ids, in closed form or "
          "the triangles of an STL file. It moves as Master translation and Master rotation say, or, with a "
          "Master body, with that rigid body. A paraboloid is one of revolution.");
      prm.add_parameter("Master file",
                        surface.file,
                        "Rigid surface of triangles: STL file, ASCII or binary, relative to the folder of the .prm "
                        "file [-]. The corners of a triangle go round counter-clockwise seen from outside of the rigid "
                        "body; the surface is closed or open, of one piece or several. Surface says whether the "
                        "triangles are rounded.",
                        Patterns::FileName());
      prm.add_parameter("Master scale",
                        surface.scale,
                        "Rigid surface of triangles: factor on the coordinates in the file, e.g. 1000 for a file in "
                        "metres and a case in millimetres [-].",
                        positive);
      prm.add_parameter("Master point",
                        surface.point,
                        "Rigid surface: a point of the plane, the centre of the sphere, a point on the axis of the "
                        "cylinder, the apex of the paraboloid, where the origin of the file of triangles is, at t = 0 "
                        "[length]; three numbers.");
      prm.add_parameter("Master axis",
                        surface.axis,
                        "Rigid surface: axis of the cylinder; normal of the plane, or of the paraboloid at its apex, "
                        "out of the rigid body, at t = 0 [-]; three numbers.");
      prm.add_parameter("Master radius",
                        surface.radius,
                        "Rigid surface: radius of sphere or cylinder, radius of curvature of the paraboloid at its "
                        "apex [length], > 0.",
                        not_negative);
      prm.add_parameter("Master cavity",
                        surface.cavity,
                        "Rigid surface: whether the slave is inside of the sphere, cylinder or paraboloid, and the "
                        "rigid body around it [-]. Triangles are turned over: the other side is outside.");
      add_motion(prm, "Master ", surface.motion, "; zero: Master axis", "Master point");
    }

    /// Where gaps and statuses are evaluated, and with which rule.
    void add_scheme(ParameterHandler &prm, ContactPairParameters &pair)
    {
      add_choice(prm,
                 "Scheme",
                 pair.scheme,
                 scheme_names,
                 "Where gaps and statuses are evaluated [-]: at the slave nodes, at the integration points of the "
                 "slave faces, or at the slave nodes with jumps averaged over their faces (mortar).");
      add_choice(prm,
                 "Integration",
                 pair.integration,
                 integration_names,
                 "Averaged scheme [-]: over whole slave faces with a fixed rule, or exactly over the overlaps of slave "
                 "and master faces.");
      add_choice(
          prm,
          "Quadrature rule",
          pair.quadrature_rule,
          rule_names,
          "Rule on slave faces of the integration point scheme, of consistent weights and of the averaged scheme "
          "by face [-].");
      prm.add_parameter("Quadrature points",
                        pair.quadrature_points,
                        "Points of that rule in each direction of a face [-]: Gauss any, Simpson odd, Newton-Cotes 2, "
                        "3, 4, 5 or 7; consistent weights take more points than the degree; 0: automatic.",
                        Patterns::Integer(0, 20));
    }

    /// Scales of gaps and slips against tractions: they steer the iteration alone.
    void add_augmentation(ParameterHandler &prm, ContactPairParameters &pair)
    {
      prm.add_parameter("Normal augmentation factor",
                        pair.normal_augmentation_factor,
                        "Factor on Young's modulus over face size, the scale of gaps against pressures [-]. It changes "
                        "the path of the iteration, not the solution.",
                        positive);
      prm.add_parameter("Tangential augmentation factor",
                        pair.tangential_augmentation_factor,
                        "Factor on the scale of slips against friction tractions [-]. It changes the path of the "
                        "iteration, not the solution.",
                        positive);
    }

    /// How areas, weights, faces and normals are made of the mesh.
    void add_surface_treatment(ParameterHandler &prm, ContactPairParameters &pair)
    {
      add_choice(
          prm, "Surface measure", pair.surface_measure, surface_measure_names, "Area that pressures refer to [-].");
      add_choice(prm,
                 "Weights",
                 pair.weights,
                 weights_names,
                 "Integration of the contact terms over slave faces [-], nodal scheme only.");
      add_choice(
          prm,
          "Surface",
          pair.surface,
          surface_names,
          "Faces of degree 1, and triangles of an STL file, as they are, or rounded to meet the averaged normals "
          "of the nodes [-]; edges fade in from 45 degrees on and stay from 60 (of triangles: 45) degrees on.");
      add_choice(prm,
                 "Normal",
                 pair.normal,
                 normal_names,
                 "Contact normal [-]: of the master face, averaged over the faces at each master node, or averaged "
                 "over the faces at the slave node.");
    }

    /// How far a site looks for its partner.
    void add_search(ParameterHandler &prm, ContactPairParameters &pair)
    {
      prm.add_parameter("Search distance",
                        pair.search_distance,
                        "Slave nodes farther than this from the master have no partner [length]; 0: automatic.",
                        not_negative);
      prm.add_parameter("Projection tolerance",
                        pair.projection_tolerance,
                        "How far a projection may hang over the rim of the master surface [face sizes]. A site that is "
                        "closed keeps its partner up to twice that.",
                        not_negative);
    }

    /// What holds before the first increment: statuses, and nodes that start inside the master.
    void add_initial_state(ParameterHandler &prm, ContactPairParameters &pair)
    {
      add_choice(prm,
                 "Initial status",
                 pair.start.status,
                 initial_status_names,
                 "Status of the slave nodes at the start, or where the pair begins to act (Active from) [-].");
      add_choice(prm,
                 "Initial overclosure",
                 pair.start.overclosure,
                 overclosure_names,
                 "What happens to slave nodes that start inside the master [-]: they are pushed out in the first "
                 "increment; or stay where they are, free of stress; or are pushed out in the course of the first "
                 "interval that the pair acts in. Tied and bilateral pairs stay where they are.");
      prm.add_parameter("Adjustment distance",
                        pair.start.adjustment_distance,
                        "Gaps up to this, too, start closed and free of stress, if overclosures stay [length]; tied "
                        "and bilateral pairs, 0: a tenth of the mean slave face.",
                        not_negative);
      prm.add_parameter("Overclosure limit",
                        pair.start.overclosure_limit,
                        "A run with a larger initial overclosure is refused [length]; 0: half of the mean slave face.",
                        not_negative);
    }
  } // namespace

  void ParameterKeys::add_contact_pair(ParameterHandler &prm, ContactPairParameters &pair)
  {
    const std::string where = "It is asked at the centres of the faces.";
    prm.add_parameter("Name", pair.name, "Name in tables and messages [-]; empty: pair <n>.", Patterns::Anything());
    add_region(prm,
               "Slave ",
               pair.slave,
               " that carries the contact pressures, better the softer one, of two alike the finer",
               where);
    add_region(prm, "Master ", pair.master, " that the slave nodes are projected onto", where);
    prm.add_parameter("Self contact",
                      pair.self_contact,
                      "Whether the slave faces touch each other [-], be they of one body or of several; then there is "
                      "no master. Without a Slave body that is general contact: of all bodies, and without ids of all "
                      "outer faces. Rigid bodies with a mesh are master alone, and do not touch each other. Of two "
                      "faces that meet that one is slave which moves while the other is held, else "
                      "that of a body less than a tenth as stiff, else the finer one, else that of the softer body, "
                      "else of the one with the lower number. What is "
                      "slave and master of another "
                      "pair is left to that pair at all times, of two pairs with Self contact to the later one.");
    add_excluded_bodies(prm, pair);
    add_master_surface(prm, pair.master_surface);
    add_scheme(prm, pair);
    add_contact_laws(prm, pair);
    add_augmentation(prm, pair);
    add_surface_treatment(prm, pair);
    add_search(prm, pair);
    add_initial_state(prm, pair);
    add_choice(prm,
               "Status test",
               pair.status_test,
               status_test_names,
               "Pressure used to decide between open and closed [-]: the weighted one is the nodal force over the "
               "nodal area.");
    add_active_time(prm, pair, "pair", "it is open, and its forces go to zero");
  }
} // namespace Nodus
