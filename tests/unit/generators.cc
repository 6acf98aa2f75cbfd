// The table of mesh generators against deal.II's functions: every example makes hexahedra, with as many arguments as
// deal.II wants, and is found right; one argument less, and each argument in words, is found wrong.

#include "parameters/generators.h"

#include "../cases.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

using namespace Nodus;
using namespace Cases;

namespace
{
  /// Coarse cells of the mesh; 0 when deal.II refuses.
  unsigned int cells_of(const std::string &name, const std::string &arguments)
  {
    dealii::Triangulation<3> mesh;
    try
    {
      dealii::GridGenerator::generate_from_name_and_arguments(
          mesh, name, Generators::arguments_for_deal_ii(name, arguments));
    }
    catch (const std::exception &)
    {
      return 0;
    }
    return mesh.all_reference_cells_are_hyper_cube() && mesh.n_levels() == 1 ? mesh.n_active_cells() : 0;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  dealii::deal_II_exceptions::disable_abort_on_exception(); // what debug mode refuses is caught
  for (const std::string &name : Generators::names())
  {
    const std::string  example = Generators::example(name);
    const unsigned int n_cells = cells_of(name, example);
    report(name + ": cells of the example",
           std::to_string(n_cells) + (n_cells > 0 && Generators::mistake_in_name(name).empty() &&
                                              Generators::mistake_in_arguments(name, example).empty()
                                          ? ""
                                          : ": NO"));

    const double counted = Generators::n_cells(name, example); // but for a factor
    report("  counted from the arguments",
           std::to_string(static_cast<unsigned int>(counted)) +
               (counted <= n_cells && n_cells <= 30. * counted ? "" : ": NO"));

    const auto   right      = dealii::Utilities::split_string_list(example, ':');
    unsigned int n_detected = 0;
    for (unsigned int wrong = 0; wrong < right.size(); ++wrong)
    {
      std::string text;
      for (unsigned int i = 0; i < right.size(); ++i)
        text += (i == 0 ? "" : " : ") + (i == wrong ? "much" : right[i]);
      n_detected += !Generators::mistake_in_arguments(name, text).empty();
    }
    n_detected +=
        !Generators::mistake_in_arguments(name, example + " : 1").empty() && cells_of(name, example + " : 1") == 0;
    check_equal("  wrong arguments that are found, and one too many", n_detected, right.size() + 1);
  }
  check(
      "cells of different widths",
      Generators::mistake_in_arguments("subdivided_hyper_rectangle", "0.5,0.5; 1; 1 : 0,0,0 : 1,1,1 : true").empty() &&
          cells_of("subdivided_hyper_rectangle", "0.5,0.5; 1; 1 : 0,0,0 : 1,1,1 : true") == 2);
  report("widths that do not fill the box",
         Generators::mistake_in_arguments("subdivided_hyper_rectangle", "0.5,0.6; 1; 1 : 0,0,0 : 1,1,1 : true"));
  report("cells along the edge",
         std::to_string(Generators::n_cells("subdivided_hyper_rectangle", "0.5,0.5; 1; 1,2,3 : 0,0,0 : 1,1,6 : true")));
  report("cells of a long cone, counted and made",
         std::to_string(static_cast<unsigned int>(Generators::n_cells("truncated_cone", "1 : 0.5 : 20"))) + ", " +
             std::to_string(cells_of("truncated_cone", "1 : 0.5 : 20")));
  check("the name of another generator of deal.II is left to it", Generators::mistake_in_name("simplex").empty());
}
