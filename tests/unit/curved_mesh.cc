// Bodies from second-order gmsh files (tests/meshes/cylinder.geo, radius 1, height 1): measures converge to pi and 2
// pi, refinement stays on the quadratic surface of the file, 20 and 27 nodes and both formats agree, regions see the
// curved faces, and two stacked cylinders carry the force E strain area through their contact.

#include "../cases.h"

#include "mesh/bodies.h"
#include "mesh/region.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <array>
#include <fstream>

using namespace Cases;

namespace
{
  constexpr double pi = dealii::numbers::PI;

  BodyParameters
  cylinder(const std::string &version, const unsigned int global_refinement = 0, const double displaced = 0.)
  {
    BodyParameters body;
    body.mesh_file               = SOURCE_DIR "/../meshes/cylinder_" + version + ".msh";
    body.global_refinement       = global_refinement;
    body.translation[2]          = displaced;
    body.material.law            = MaterialParameters::Law::linear_elastic;
    body.material.youngs_modulus = 1000.;
    body.material.poissons_ratio = 0.;
    return body;
  }

  struct Measures
  {
    double volume = 0., mantle = 0.;
  };

  Measures measure(const BodyParameters &parameters, const unsigned int degree)
  {
    const Bodies              bodies({parameters}, world());
    const auto                mapping = bodies.make_mapping(degree);
    dealii::FE_Nothing<dim>   nothing;
    dealii::FEValues<dim>     volume(*mapping, nothing, dealii::QGauss<dim>(4), dealii::update_JxW_values);
    dealii::FEFaceValues<dim> face(*mapping, nothing, dealii::QGauss<dim - 1>(8), dealii::update_JxW_values);
    Measures                  sum;
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
      {
        volume.reinit(cell);
        for (const double JxW : volume.get_JxW_values())
          sum.volume += JxW;
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == 3)
          {
            face.reinit(cell, f);
            for (const double JxW : face.get_JxW_values())
              sum.mantle += JxW;
          }
      }
    sum.volume = dealii::Utilities::MPI::sum(sum.volume, world());
    sum.mantle = dealii::Utilities::MPI::sum(sum.mantle, world());
    return sum;
  }

  void convergence()
  {
    // The sagitta of a parabola through three points of a circle: its area is short by O(h^4), that of chords by
    // O(h^2).
    for (const unsigned int degree : {2u, 1u})
    {
      Measures coarser;
      for (const std::string n : {"1", "2", "4"})
      {
        Measures error = measure(cylinder("27_" + n), degree);
        error.volume   = 1e3 * std::abs(error.volume / pi - 1.);
        error.mantle   = 1e3 * std::abs(error.mantle / (2. * pi) - 1.);
        if (root())
        {
          std::cout << "degree " << degree << ", n = " << n << std::fixed << std::setprecision(5)
                    << ": errors in 1/1000: volume " << error.volume << ", mantle " << error.mantle;
          if (n != "1")
            std::cout << ", orders " << std::setprecision(2) << std::log2(coarser.volume / error.volume) << " "
                      << std::log2(coarser.mantle / error.mantle);
          std::cout << std::defaultfloat << std::endl;
        }
        coarser = error;
      }
    }
    // inscribed polygon with 8 sides
    check("degree 1: area of the octagon", measure(cylinder("27_2"), 1).volume, 4. * std::sin(pi / 4.), 1e-7);
    // 4 parabolas of sagitta 1 - cos(pi/4): square + 4 * 2/3 * chord * sagitta
    check("degree 2: area under four parabolas",
          measure(cylinder("27_1"), 2).volume,
          2. + 8. / 3. * std::sqrt(2.) * (1. - std::sqrt(0.5)),
          1e-7);
  }

  void equal_files()
  {
    const Measures reference = measure(cylinder("27_2"), 2);
    for (const std::string other : {"27_2_format_22", "20_2", "20_2_format_22"})
    {
      const Measures m = measure(cylinder(other), 2);
      check(other + ": volume as 27_2", m.volume, reference.volume, 1e-13);
      check(other + ": mantle as 27_2", m.mantle, reference.mantle, 1e-13);
    }
    const Measures corners = measure(cylinder("27_2"), 1), first_order = measure(cylinder("8_2"), 2);
    check("8_2: volume as the corners of 27_2", first_order.volume, corners.volume, 1e-13);
    check("8_2: mantle as the corners of 27_2", first_order.mantle, corners.mantle, 1e-13);
  }

  /// Distance of a point of the mantle from the nearest of the points with parameter k/4 of the four parabolas through
  /// the points of the unit circle at multiples of pi/4; the height of refined vertices is a multiple of 1/4.
  double off_parabolas(const Point &x)
  {
    double nearest = 1e100;
    for (unsigned int quarter = 0; quarter < 4; ++quarter)
      for (unsigned int k = 0; k < 4; ++k)
      {
        const auto circle = [&](const double step)
        {
          const double angle = (quarter + step) * pi / 2.;
          return Point(std::cos(angle), std::sin(angle), 0.);
        };
        const double s = k / 4.;
        const auto   p =
            (2 * s - 1) * (s - 1) * circle(0.) + 4 * s * (1 - s) * circle(0.5) + s * (2 * s - 1) * circle(1.);
        const double z = std::lround(4. * x[2]) / 4.;
        nearest        = std::min(nearest, x.distance(Point(p[0], p[1], z)));
      }
    return nearest;
  }

  void refinement()
  {
    const Measures coarse = measure(cylinder("27_1"), 2);
    for (const unsigned int level : {1u, 2u})
    {
      const Measures fine = measure(cylinder("27_1", level), 2);
      check("refined " + std::to_string(level) + ": volume stays", fine.volume, coarse.volume, 1e-12);
      check("refined " + std::to_string(level) + ": mantle stays", fine.mantle, coarse.mantle, 1e-6);
    }
    double before = 0.;
    for (const unsigned int level : {0u, 1u, 2u, 3u})
    {
      const double error = coarse.volume - measure(cylinder("27_1", level), 1).volume;
      if (level > 0 && root())
        std::cout << "degree 1, refined " << level << ": volume approaches that of degree 2 with order " << std::fixed
                  << std::setprecision(2) << std::log2(before / error) << std::defaultfloat << std::endl;
      before = error;
    }

    // placed: undo rotation by 90 degrees about z, scale and translation
    auto placed             = cylinder("27_1", 2);
    placed.scale            = 2.;
    placed.rotation_axis[2] = 1.;
    placed.rotation_angle   = 90.;
    placed.translation      = Vector3(Point(3., 4., 5.));
    const Bodies bodies({cylinder("8_2"), placed}, world());
    const auto   mapping    = bodies.make_mapping(2);
    double       vertex_off = 0., middle_off = 0., in_common = 0.;
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (!cell->is_artificial() && cell->material_id() == 1)
      {
        for (const unsigned int v : cell->vertex_indices())
          in_common = std::max(in_common,
                               cell->vertex(v).distance(mapping->transform_unit_to_real_cell(
                                   cell, dealii::GeometryInfo<dim>::unit_cell_vertex(v))));
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == 3)
          {
            Point average, centre(0.5, 0.5, 0.5);
            for (const unsigned int v : cell->face(f)->vertex_indices())
            {
              const Point x = Point((cell->face(f)->vertex(v) - placed.translation) / placed.scale);
              vertex_off    = std::max(vertex_off, off_parabolas(x));
              average += 0.25 * x;
            }
            centre[f / 2]    = f % 2;
            const auto    x  = mapping->transform_unit_to_real_cell(cell, centre) - placed.translation;
            const Vector3 up = x / placed.scale - average;
            // sagitta of a parabola of which a quarter is left: (1 - cos(pi/4)) / 16, along the middle of the quadrant
            middle_off = std::max(middle_off, std::abs(up.norm() - (1. - std::sqrt(0.5)) / 16.));
          }
      }
    // gmsh puts the middle of an arc within 4e-9 along the arc
    check("vertices of the refined mantle on the parabolas", dealii::Utilities::MPI::max(vertex_off, world()) < 1e-8);
    check("middles of the refined mantle bulge like them", dealii::Utilities::MPI::max(middle_off, world()) < 1e-8);
    check("mapping and vertices agree", dealii::Utilities::MPI::max(in_common, world()) < 1e-14);
    const auto ends = bodies.bounding_box(1).get_boundary_points();
    check("box, smallest x", ends.first[0], 1., 1e-8);
    check("box, largest z", ends.second[2], 7., 1e-8);
  }

  void regions()
  {
    const Bodies bodies({cylinder("27_1")}, world());
    const Region region(Cases::region(1, {3}, "x^2 + y^2 > 0.99"), bodies, "test");
    for (const unsigned int degree : {1u, 2u})
    {
      const auto   mapping = bodies.make_mapping(degree);
      unsigned int n       = 0;
      for (const auto &cell : bodies.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int f : cell->face_indices())
            n += region.selects_face(*mapping, cell, f);
      n = dealii::Utilities::MPI::sum(n, world());
      if (root())
        std::cout << "degree " << degree << ": mantle faces with the centre outside of r = 0.995: " << n << std::endl;
    }
  }

  /// The upper cylinder is pressed on the lower one; with Poisson's ratio 0 the stress is uniform, so that the force is
  /// E * strain * area = 1000 * 0.001 * area of the mesh, whatever the element, at the contact and at the support.
  void stacked(const std::string &version, const unsigned int degree, const unsigned int level)
  {
    Parameters p;
    p.degree = degree;
    p.bodies = {cylinder(version, level), cylinder(version, level, 1.)};
    p.boundary_conditions.push_back(hold("ground", region(1, {1}), {0, 1, 2}));
    p.boundary_conditions.push_back(hold("guide", region(2, {2}), {0, 1}));
    p.boundary_conditions.push_back(drive("stamp", region(2, {2}), 2, "-0.002*t"));
    p.contact_pairs.push_back(pair(region(2, {1}), region(1, {2})));
    p.contact_pairs[0].weights    = ContactPairParameters::Weights::dual; // nodal areas exact on every quadrilateral
    p.load_stepping.interval_ends = {1.};
    p.load_stepping.increments    = {1};
    p.output.results_folder       = "curved_mesh_results";
    ContactProblem problem(p, world(), log());
    problem.run();

    const double      area   = measure(cylinder(version, level), degree).volume;
    const std::string title  = version + ", degree " + std::to_string(degree) + ", refined " + std::to_string(level);
    const auto       &fields = problem.contact_fields()[0];
    check(title + ": contact force", problem.contact_resultants()[0].slave_force[2], area, 1e-6);
    check(title + ": support", problem.reactions()[0].second[2], area, 1e-6);
    check(title + ": smallest pressure", *std::min_element(fields.pressure.begin(), fields.pressure.end()), 1., 1e-5);
    check(title + ": largest pressure", *std::max_element(fields.pressure.begin(), fields.pressure.end()), 1., 1e-5);
  }

  /// The message for cylinder_27_2_format_22.msh with @p what replaced by @p by.
  void refused(const std::string &title, const std::string &what, const std::string &by)
  {
    if (root())
    {
      std::ifstream      in(cylinder("27_2_format_22").mesh_file);
      std::ostringstream text;
      text << in.rdbuf();
      std::string changed = text.str();
      changed.replace(changed.find(what), what.size(), by);
      std::ofstream("refused.msh") << changed;
    }
    MPI_Barrier(world());
    auto body           = cylinder("27_2");
    body.mesh_file      = "refused.msh";
    std::string message = "accepted";
    try
    {
      Bodies({body}, world());
    }
    catch (const InputError &error)
    {
      message = error.what();
    }
    if (root())
      std::cout << title << ": " << message << std::endl;
    MPI_Barrier(world());
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  convergence();
  equal_files();
  refinement();
  regions();
  for (const std::string version : {"27_2", "20_2"})
    for (const unsigned int degree : {1u, 2u})
      stacked(version, degree, 0);
  stacked("27_1", 1, 1);
  stacked("27_1", 2, 1);
  refused("an arc bent through its cell", "18 0.9238795320428508 0.3826834334959943 0", "18 0.2 0.1 0");
  refused("20 and 27 nodes", "68 12 2 1 5", "68 17 2 1 5");
  refused("third order", "68 12 2 1 5", "68 92 2 1 5");
}
