// Bodies and regions: touching bodies stay separate, ids survive, both gmsh formats read alike, placement and
// refinement keep curved bodies round, and every kind of unusable input is refused with a message that names the body.

#include "mesh/bodies.h"
#include "mesh/region.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

using namespace Nodus;

namespace
{
  const MPI_Comm communicator = MPI_COMM_WORLD;
  bool           root;

  void print(const std::string &line)
  {
    if (root)
      std::cout << line << std::endl;
  }

  BodyParameters generated(const std::string &name, const std::string &generator, const std::string &arguments)
  {
    BodyParameters body;
    body.name                = name;
    body.generator           = generator;
    body.generator_arguments = arguments;
    return body;
  }

  BodyParameters from_file(const std::string &file, const std::vector<unsigned int> &volume_ids = {})
  {
    BodyParameters body;
    body.mesh_file  = file;
    body.volume_ids = volume_ids;
    return body;
  }

  /// Counts and measures of each body, summed over the ranks.
  void describe(const std::string &title, const std::vector<BodyParameters> &parameters)
  {
    const Bodies bodies(parameters, communicator);
    print(title + ": " + std::to_string(bodies.triangulation().n_global_active_cells()) + " cells");
    for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      unsigned int                                 cells = 0, faces = 0;
      double                                       volume = 0.;
      std::map<dealii::types::boundary_id, double> area;
      for (const auto id : bodies.boundary_ids(b))
        area[id] = 0.;
      for (const auto &cell : bodies.triangulation().active_cell_iterators())
        if (cell->is_locally_owned() && cell->material_id() == b)
        {
          ++cells;
          volume += cell->measure();
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary())
            {
              ++faces;
              area.at(face->boundary_id()) += face->measure();
            }
        }
      std::ostringstream line;
      line << std::fixed << std::setprecision(4) << "  " << bodies.name(b) << ": cells "
           << dealii::Utilities::MPI::sum(cells, communicator) << " faces "
           << dealii::Utilities::MPI::sum(faces, communicator) << " volume "
           << dealii::Utilities::MPI::sum(volume, communicator) << " areas";
      for (const auto &[id, a] : area)
        line << " " << id << ": " << dealii::Utilities::MPI::sum(a, communicator);
      line << " box";
      for (unsigned int d = 0; d < dim; ++d)
        line << " [" << bodies.bounding_box(b).lower_bound(d) + 0. << ", " << bodies.bounding_box(b).upper_bound(d) + 0.
             << "]";
      print(line.str());
    }
  }

  template <typename Function>
  void refused(const std::string &title, const Function &function)
  {
    try
    {
      function();
      print(title + ": accepted");
    }
    catch (const InputError &error)
    {
      std::istringstream words(error.what()); // deal.II's messages hold line breaks
      std::string        line, word;
      while (words >> word)
        line += " " + word;
      print(title + ":" + line);
    }
  }

  void refused_bodies(const std::string &title, const std::vector<BodyParameters> &parameters)
  {
    refused(title, [&] { Bodies(parameters, communicator); });
  }

  void write(const std::string &file, const std::string &text)
  {
    if (root)
      std::ofstream(file) << text;
    MPI_Barrier(communicator);
  }

  // Two unit cubes on top of each other, volumes 1 and 2, that share the nodes 5-8 of their interface; physical
  // surfaces: 7 bottom, 8 interface, 9 top. The second cube's nodes are in the mirrored order.
  const std::string nodes = "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n"
                            "9 0 0 2\n10 1 0 2\n11 1 1 2\n12 0 1 2\n";
  const std::string format_22 =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
      "$PhysicalNames\n1\n3 1 \"lower cube\"\n$EndPhysicalNames\n"
      "$Nodes\n13\n" +
      nodes +
      "13 5 5 5\n$EndNodes\n"
      "$Elements\n6\n1 15 2 0 1 13\n2 3 2 7 1 1 2 3 4\n3 3 2 8 2 5 6 7 8\n4 3 2 9 3 9 10 11 12\n"
      "5 5 2 1 1 1 2 3 4 5 6 7 8\n6 5 2 2 2 9 10 11 12 5 6 7 8\n$EndElements\n";

  std::string format_41()
  {
    std::istringstream in(nodes);
    std::string        tags, positions, tag, x, y, z;
    while (in >> tag >> x >> y >> z)
    {
      tags += tag + "\n";
      positions += x + " " + y + " " + z + "\n";
    }
    return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
           "$Entities\n1 0 3 2\n1 0 0 0 0\n"
           "1 0 0 0 1 1 0 1 7 0\n2 0 0 1 1 1 1 1 -8 0\n3 0 0 2 1 1 2 1 9 0\n"
           "1 0 0 0 1 1 1 1 1 2 1 2\n2 0 0 1 1 1 2 1 2 2 2 3\n$EndEntities\n"
           "$Nodes\n1 12 1 12\n3 1 0 12\n" +
           tags + positions +
           "$EndNodes\n"
           "$Periodic\n0\n$EndPeriodic\n"
           "$Elements\n5 5 1 5\n2 1 3 1\n1 1 2 3 4\n2 2 3 1\n2 5 6 7 8\n2 3 3 1\n3 9 10 11 12\n"
           "3 1 5 1\n4 1 2 3 4 5 6 7 8\n3 2 5 1\n5 9 10 11 12 5 6 7 8\n$EndElements\n";
  }

  std::string replaced(std::string text, const std::string &what, const std::string &by)
  {
    return text.replace(text.find(what), what.size(), by);
  }

  void check_region(const Bodies &bodies)
  {
    const auto make = [&](const unsigned int body, const std::vector<unsigned int> &ids, const std::string &where)
    {
      RegionParameters parameters;
      if (body > 0)
        parameters.bodies = {body};
      parameters.boundary_ids.assign(ids.begin(), ids.end());
      parameters.where = where;
      return Region(parameters, bodies, "Contact pair 1, slave");
    };
    const Region region = make(2, {4}, "x < 0.5 && y > -sin(pi/2)");
    unsigned int in = 0, lower = 0;
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (region.contains_face(cell, f))
          {
            ++in;
            lower += region.contains_point(cell->face(f)->center());
          }
    in    = dealii::Utilities::MPI::sum(in, communicator);
    lower = dealii::Utilities::MPI::sum(lower, communicator);
    print("region: faces " + std::to_string(in) + ", with x < 1/2 " + std::to_string(lower));
    refused("unknown body", [&] { make(3, {4}, ""); });
    refused("unknown id", [&] { make(1, {4, 17}, ""); });
    refused("unknown id everywhere", [&] { make(0, {17}, ""); });
    refused("bad predicate", [&] { make(1, {4}, "x < "); });
    refused("unknown name", [&] { make(1, {4}, "x < radius"); });
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  root = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;

  const auto lower = generated("lower", "subdivided_hyper_rectangle", "2,2,2 : 0,0,0 : 1,1,1 : true");
  auto       upper = lower;
  upper.name.clear();
  upper.translation[2] = 1.;
  describe("touching", {lower, upper});
  check_region(Bodies({lower, upper}, communicator));

  upper.global_refinement = 1;
  upper.scale             = 2.;
  upper.rotation_axis[2]  = 3.;
  upper.rotation_angle    = 90.;
  describe("placed and refined", {lower, upper});

  // Every boundary vertex of a placed ball must lie on its sphere, also where the manifold interpolates.
  for (const auto &[generator, arguments] :
       {std::make_pair("hyper_ball", "0,0,0 : 1 : true"), std::make_pair("hyper_ball_balanced", "0,0,0 : 1")})
  {
    auto ball              = generated("ball", generator, arguments);
    ball.global_refinement = 2;
    ball.scale             = 0.5;
    ball.rotation_axis[0] = ball.rotation_axis[1] = 1.;
    ball.rotation_angle                           = 30.;
    ball.translation[0]                           = 3.;
    const Bodies bodies({lower, ball}, communicator);
    double       error = 0., volume = 0.;
    for (const auto &cell : bodies.triangulation().active_cell_iterators())
      if (cell->is_locally_owned() && cell->material_id() == 1)
      {
        volume += cell->measure();
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            for (const unsigned int v : face->vertex_indices())
              error = std::max(error, std::abs(face->vertex(v).distance(Point(3, 0, 0)) - 0.5));
      }
    error  = dealii::Utilities::MPI::max(error, communicator);
    volume = dealii::Utilities::MPI::sum(volume, communicator);
    std::ostringstream line;
    line << generator << ": off the sphere " << (error < 1e-12 ? "nowhere" : "somewhere") << ", volume / exact "
         << std::setprecision(5) << volume / (4. / 3. * dealii::numbers::PI * 0.125);
    print(line.str());
  }

  write("two_22.msh", format_22);
  write("two_41.msh", format_41());
  for (const std::string file : {"two_22.msh", "two_41.msh"})
  {
    describe(file + " as one body", {from_file(file)});
    describe(file + " as two bodies", {from_file(file, {1}), from_file(file, {2})});
  }

  write("cubic.msh", replaced(format_22, "6 5 2 2 2", "6 92 2 2 2"));
  write("tetrahedra.msh", replaced(format_22, "6 5 2 2 2 9 10 11 12 5 6 7 8", "6 4 2 2 2 9 10 11 5"));
  write("tangled.msh", replaced(format_22, "5 5 2 1 1 1 2 3 4", "5 5 2 1 1 2 1 3 4"));
  write("binary.msh", replaced(format_22, "2.2 0 8", "2.2 1 8"));
  write("old.msh", replaced(format_22, "2.2 0 8", "4 0 8"));
  write("cut.msh", format_22.substr(0, format_22.size() - 40));
  write("two_ids.msh", replaced(format_22, "4 3 2 9 3 9 10 11 12", "4 3 2 9 3 2 1 4 3"));
  write("text.msh", "hello\n");
  write("twice.msh", replaced(format_22, "13 5 5 5", "12 5 5 5"));
  write("nowhere_at.msh", replaced(format_22, "13 5 5 5", "13 5 nan 5"));
  write("endless.msh", replaced(format_22, "1 15 2 0 1 13", "1 15 4000000000000 0 1 13"));
  write("stray.msh", replaced(format_22, "3 3 2 8 2 5 6 7 8", "3 3 2 9 2 5 6 7 1"));
  refused_bodies("third order", {lower, from_file("cubic.msh")});
  refused_bodies("missing", {from_file("nowhere.msh")});
  refused_bodies("tetrahedra", {from_file("tetrahedra.msh")});
  refused_bodies("tetrahedra not selected", {from_file("tetrahedra.msh", {1})});
  refused_bodies("tangled", {from_file("tangled.msh")});
  refused_bodies("binary", {from_file("binary.msh")});
  refused_bodies("old", {from_file("old.msh")});
  refused_bodies("cut", {from_file("cut.msh")});
  refused_bodies("two ids", {from_file("two_ids.msh")});
  refused_bodies("no mesh", {from_file("text.msh")});
  refused_bodies("node defined twice", {from_file("twice.msh")});
  refused_bodies("position that is no number", {from_file("nowhere_at.msh")});
  refused_bodies("more entries than the file has", {from_file("endless.msh")});
  refused_bodies("a face that is none of a cell", {from_file("stray.msh")});
  refused_bodies("volume id", {from_file("two_41.msh", {1, 5})});
  refused_bodies("generator", {generated("block", "hyper_blob", "0 : 1")});
  refused_bodies("arguments", {generated("block", "hyper_cube", "0 : one")});
  refused("simplices",
          []
          {
            try
            {
              Bodies({generated("block", "subdivided_hyper_cube_with_simplices", "2 : 0 : 1 : false")}, communicator);
            }
            catch (const InputError &error) // newer versions of deal.II know the generator, older ones do not
            {
              const std::string text(error.what());
              throw InputError(text.substr(0, text.find("2 : 0 : 1 : false")));
            }
          });
  upper.rotation_axis = Vector3();
  refused_bodies("axis", {upper});
  refused_bodies("nothing", {BodyParameters()});
}
