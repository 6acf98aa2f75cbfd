#include "parameters/generators.h"
#include "base/suggestion.h"
#include "parameters/argument_kind.h"

#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <type_traits>
#include <utility>

namespace Nodus
{
  namespace Generators
  {
    namespace
    {
      using Kind = ArgumentKind;

      struct Argument
      {
        const char *meaning;
        Kind        kind;
        const char *usual = ""; ///< the default of deal.II's function
      };

      /// Of two arguments the first is smaller: deal.II looks at that in debug mode, if at all.
      struct Order
      {
        const char  *name;
        unsigned int smaller, larger;
      };
      constexpr Order orders[] = {{"hyper_cube", 0, 1},
                                  {"subdivided_hyper_cube", 1, 2},
                                  {"cylinder_shell", 1, 2},
                                  {"hyper_shell", 1, 2},
                                  {"half_hyper_shell", 1, 2},
                                  {"quarter_hyper_shell", 1, 2},
                                  {"concentric_hyper_shells", 1, 2},
                                  {"hyper_cube_with_cylindrical_hole", 0, 1},
                                  {"plate_with_a_hole", 0, 1},
                                  {"enclosed_hyper_cube", 0, 1},
                                  {"hyper_L", 0, 1},
                                  {"torus", 1, 0},
                                  {"moebius", 3, 2}};

      /// Arguments whose numbers multiply to that of the cells, times a factor; an argument may come twice.
      struct Count
      {
        const char               *name;
        std::vector<unsigned int> arguments;
      };
      const Count counts[] = {{"subdivided_hyper_rectangle", {0}},
                              {"subdivided_hyper_cube", {0, 0, 0}},
                              {"cylinder_shell", {3, 4}},
                              {"truncated_cone", {}},
                              {"concentric_hyper_shells", {3}},
                              {"hyper_cube_with_cylindrical_hole", {3}},
                              {"plate_with_a_hole", {10}},
                              {"hyper_cross", {0}},
                              {"cheese", {0}},
                              {"torus", {2}},
                              {"moebius", {0}}};

      struct Generator
      {
        const char           *name;
        std::vector<Argument> arguments;
        const char           *example;
      };

      const Argument colorize = {"whether the sides have ids of their own", Kind::choice, "true"};
      const Argument left     = {"smallest coordinate", Kind::number, "0"},
                     right    = {"largest coordinate", Kind::number, "1"};
      const Argument centre = {"centre", Kind::point, "0,0,0"}, radius = {"radius", Kind::positive, "1"};
      const Argument inner = {"inner radius", Kind::positive}, outer = {"outer radius", Kind::positive};
      const Argument half_length = {"half of the length along x", Kind::positive, "1"};

      /// In the order of how often they serve.
      const std::vector<Generator> &table()
      {
        static const std::vector<Generator> all = {
            {"subdivided_hyper_rectangle",
             {{"cells along x, y, z", Kind::steps},
              {"a corner", Kind::point},
              {"the corner opposite to it", Kind::point},
              colorize},
             "3,3,2 : 0,0,0 : 1,1,1 : true"},
            {"hyper_rectangle",
             {{"a corner", Kind::point}, {"the corner opposite to it", Kind::point}, colorize},
             "0,0,0 : 2,1,1 : true"},
            {"hyper_cube", {left, right, colorize}, "0 : 1 : true"},
            {"subdivided_hyper_cube",
             {{"cells along each edge", Kind::natural}, left, right, colorize},
             "4 : 0 : 1 : true"},
            {"cylinder", {radius, half_length}, "0.5 : 2"},
            {"cylinder_shell",
             {{"length along z, from z = 0", Kind::positive},
              inner,
              outer,
              {"cells around; 0: as many as make cells even", Kind::whole, "0"},
              {"cells along z; 0: likewise", Kind::whole, "0"}},
             "1 : 0.5 : 1 : 16 : 2"},
            {"truncated_cone",
             {{"radius at x-", Kind::positive, "1"}, {"radius at x+", Kind::positive, "0.5"}, half_length},
             "1 : 0.5 : 1"},
            {"hyper_ball",
             {centre, radius, {"whether cells at the surface alone are curved", Kind::choice, "false"}},
             "0,0,0 : 1 : false"},
            {"half_hyper_ball", {centre, radius}, "0,0,0 : 1"},
            {"quarter_hyper_ball", {centre, radius}, "0,0,0 : 1"},
            {"hyper_shell",
             {centre,
              inner,
              outer,
              {"cells: 6, 12 or 96, or, without ids of their own, 24 or 48; 0: 6", Kind::whole, "0"},
              colorize},
             "0,0,0 : 0.5 : 1 : 12 : true"},
            {"half_hyper_shell",
             {centre, inner, outer, {"cells: 0 (as many as there are)", Kind::whole, "0"}, colorize},
             "0,0,0 : 0.5 : 1 : 0 : true"},
            {"quarter_hyper_shell",
             {centre, inner, outer, {"cells: 0 (as many as there are)", Kind::whole, "0"}, colorize},
             "0,0,0 : 0.5 : 1 : 0 : true"},
            {"concentric_hyper_shells",
             {centre,
              inner,
              outer,
              {"layers", Kind::natural, "1"},
              {"grading of the layers; 0: none", Kind::number, "0"},
              {"cells of a layer: 6 or 12; 0: 12", Kind::whole, "0"},
              colorize},
             "0,0,0 : 0.5 : 1 : 2 : 0 : 0 : true"},
            {"hyper_cube_with_cylindrical_hole",
             {{"radius of the hole", Kind::positive, "0.25"},
              {"half of the edge", Kind::positive, "0.5"},
              {"thickness along z", Kind::positive, "0.5"},
              {"cells along z", Kind::natural, "1"},
              colorize},
             "0.25 : 0.5 : 0.5 : 1 : true"},
            {"plate_with_a_hole",
             {{"radius of the hole", Kind::positive, "0.4"},
              {"half of the edge of the square around it", Kind::positive, "1"},
              {"what is added at y-", Kind::number, "2"},
              {"what is added at y+", Kind::number, "2"},
              {"what is added at x-", Kind::number, "1"},
              {"what is added at x+", Kind::number, "1"},
              {"centre of the hole", Kind::point, "0,0,0"},
              {"a number for the round manifold", Kind::whole, "0"},
              {"another number for that around it", Kind::whole, "1"},
              {"thickness along z", Kind::positive, "1"},
              {"layers of nodes along z", Kind::natural, "2"},
              colorize},
             "0.4 : 1 : 2 : 2 : 1 : 1 : 0,0,0 : 0 : 1 : 1 : 2 : true"},
            {"enclosed_hyper_cube",
             {left, right, {"thickness of the layer around the cube", Kind::positive, "1"}, colorize},
             "0 : 1 : 0.5 : true"},
            {"hyper_L",
             {left,
              right,
              {"whether the sides have ids of their own, which deal.II cannot give here", Kind::choice, "false"}},
             "-1 : 1 : false"},
            {"hyper_cross",
             {{"cells of the six arms: x-, x+, y-, y+, z-, z+", Kind::wholes},
              {"whether the cells have ids of their own", Kind::choice, "false"}},
             "1,1,1,1,1,1 : false"},
            {"cheese", {{"holes along x, y, z", Kind::cells}}, "2,2,2"},
            {"torus",
             {{"radius of the centre line, about the y axis", Kind::positive},
              {"radius of the tube", Kind::positive},
              {"cells along the centre line", Kind::natural, "6"},
              {"angle of the torus in radians", Kind::positive, "6.283185307179586"}},
             "1 : 0.3 : 6 : 6.283185307179586"},
            {"moebius",
             {{"cells along the loop", Kind::natural},
              {"quarters of a turn", Kind::whole},
              {"radius of the loop", Kind::positive},
              {"radius of the section", Kind::positive}},
             "12 : 2 : 2 : 0.5"},
            {"general_cell",
             {{"eight vertices separated by ';'", Kind::points}, colorize},
             "0,0,0; 1,0,0; 0,1,0; 1,1,0; 0,0,1; 1,0,1; 0,1,1; 1,1,1 : true"}};
        return all;
      }

      const Generator *find(const std::string &name)
      {
        const auto found =
            std::find_if(table().begin(), table().end(), [&](const Generator &g) { return g.name == name; });
        return found == table().end() ? nullptr : &*found;
      }

      /// Widths of cells must fill the box: deal.II looks at that in debug mode alone. @p given: arguments of
      /// subdivided_hyper_rectangle.
      std::string mistake_in_widths(const std::vector<std::string> &given)
      {
        const auto widths = dealii::Utilities::split_string_list(given[0], ';');
        const auto from   = dealii::Utilities::string_to_double(dealii::Utilities::split_string_list(given[1], ','));
        const auto to     = dealii::Utilities::string_to_double(dealii::Utilities::split_string_list(given[2], ','));
        for (unsigned int d = 0; d < widths.size(); ++d)
        {
          double sum = 0.;
          for (const double width :
               dealii::Utilities::string_to_double(dealii::Utilities::split_string_list(widths[d], ',')))
            sum += width;
          if (const double length = std::abs(to[d] - from[d]); std::abs(sum - length) > 1e-8 * length)
          {
            std::ostringstream text;
            text << "has widths of cells along "
                 << "xyz"[d] << " that add up to " << sum << ", but the corners are " << length << " apart";
            return text.str();
          }
        }
        return "";
      }
    } // namespace

    std::vector<std::string> names()
    {
      std::vector<std::string> list;
      for (const Generator &generator : table())
        list.push_back(generator.name);
      return list;
    }

    std::string arguments(const std::string &name)
    {
      std::string text;
      for (const Argument &argument : find(name)->arguments)
        text += (text.empty() ? "" : " : ") + std::string(argument.meaning) + " (" + in_words(argument.kind) +
                (*argument.usual == '\0' ? "" : std::string("; usually ") + argument.usual) + ')';
      return text;
    }

    std::string example(const std::string &name)
    {
      return find(name)->example;
    }

    double n_cells(const std::string &name, const std::string &arguments)
    {
      const auto given = dealii::Utilities::split_string_list(arguments, ':');
      const auto count =
          std::find_if(std::begin(counts), std::end(counts), [&](const Count &c) { return c.name == name; });
      if (count == std::end(counts) || find(name) == nullptr || !mistake_in_arguments(name, arguments).empty())
        return 1.;
      double n = 1.;
      if (name == "cylinder_shell") // 0: as many as make cells even
      {
        const double length = dealii::Utilities::string_to_double(given[0]),
                     inner  = dealii::Utilities::string_to_double(given[1]),
                     outer  = dealii::Utilities::string_to_double(given[2]);
        n *= given[3] == "0" ? std::max(1., dealii::numbers::PI * (inner + outer) / (outer - inner)) : 1.;
        n *= given[4] == "0" ? std::max(1., length / (outer - inner)) : 1.;
      }
      if (name == "truncated_cone") // slices of five cells, as long as the larger radius
        n *= 5. * std::max(1.,
                           dealii::Utilities::string_to_double(given[2]) /
                               std::max(dealii::Utilities::string_to_double(given[0]),
                                        dealii::Utilities::string_to_double(given[1])));
      if (name == "plate_with_a_hole") // what is added has cells as large as half of the square, at least half as
                                       // many layers as there are of nodes
      {
        const auto rows = [&](const unsigned int before, const unsigned int after)
        {
          const double added =
              dealii::Utilities::string_to_double(given[before]) + dealii::Utilities::string_to_double(given[after]);
          return 2. + std::max(0., added) / dealii::Utilities::string_to_double(given[1]);
        };
        n *= 0.5 * rows(2, 3) * rows(4, 5);
      }
      for (const unsigned int i : count->arguments)
      {
        const auto kind    = find(name)->arguments[i].kind;
        const bool widths  = kind == Kind::steps && given[i].find(';') != std::string::npos;
        double     product = 1., sum = 0.;
        for (const std::string &item : dealii::Utilities::split_string_list(given[i], widths ? ';' : ','))
        {
          const double number = widths ? double(dealii::Utilities::split_string_list(item, ',').size())
                                       : dealii::Utilities::string_to_double(item);
          product *= std::max(1., number);
          sum += number;
        }
        n *= kind == Kind::wholes ? std::max(1., sum) : product;
      }
      return n;
    }

    std::string mistake_in_name(const std::string &name)
    {
      if (find(name) != nullptr)
        return "";
      // Versions of deal.II differ in what they have, and say so of names only when they are asked for a mesh.
      try
      {
        dealii::Triangulation<3> mesh;
        dealii::GridGenerator::generate_from_name_and_arguments(mesh, name, "");
      }
      catch (const std::exception &error)
      {
        if (std::string(error.what()).find("not implemented") != std::string::npos)
          return "is '" + name + "', which is no generator of hexahedra" + suggestion(name, names());
      }
      return "";
    }

    std::string mistake_in_arguments(const std::string &name, const std::string &text)
    {
      const Generator *const generator = find(name);
      if (generator == nullptr)
        return "";
      const auto        given    = dealii::Utilities::split_string_list(text, ':');
      const auto       &expected = generator->arguments;
      const std::size_t n        = expected.size();
      std::string       wrong;
      if (given.size() != n)
        wrong = "has " + std::to_string(given.size()) + (given.size() == 1 ? " argument" : " arguments") + ", but " +
                name + " takes " + std::to_string(n);
      for (std::size_t i = 0; i < n && wrong.empty(); ++i)
        if (!matches(expected[i].kind, given[i]))
          wrong = "has '" + given[i] + "' for argument " + std::to_string(i + 1) + " of " + name + ", " +
                  expected[i].meaning + ", which must be " + in_words(expected[i].kind);
      for (const Order &order : orders)
        if (wrong.empty() && order.name == name &&
            dealii::Utilities::string_to_double(given[order.smaller]) >=
                dealii::Utilities::string_to_double(given[order.larger]))
          wrong = "has " + given[order.smaller] + " for " + expected[order.smaller].meaning + " of " + name +
                  ", which must be smaller than the " + given[order.larger] + " for " + expected[order.larger].meaning;
      if (wrong.empty() && name == "concentric_hyper_shells" && given[5] != "0" && given[5] != "6" && given[5] != "12")
        wrong = "has " + given[5] + " cells of a layer, which must be 0, 6 or 12"; // deal.II crashes
      if (wrong.empty() && name == "subdivided_hyper_rectangle" && given[0].find(';') != std::string::npos)
        wrong = mistake_in_widths(given);
      if (!wrong.empty())
        wrong += "; give, separated by ':', " + arguments(name) + "; for example " + generator->example;
      return wrong;
    }

    namespace
    {
      template <typename Mesh, typename = void>
      struct CylinderShellHasColours : std::false_type
      {
      };
      template <typename Mesh>
      struct CylinderShellHasColours<Mesh,
                                     decltype(dealii::GridGenerator::cylinder_shell(
                                         std::declval<Mesh &>(), 1., 1., 2., 0u, 0u, false))> : std::true_type
      {
      };
    } // namespace

    std::string arguments_for_deal_ii(const std::string &name, const std::string &arguments)
    {
      const bool has_colours = CylinderShellHasColours<dealii::Triangulation<3>>::value;
      return arguments + (has_colours && name == "cylinder_shell" ? " : false" : "");
    }

    std::set<unsigned int> boundary_ids(const std::string &name, const std::string &arguments)
    {
      constexpr double quickly_made = 1e5;
      if (!mistake_in_name(name).empty() || !mistake_in_arguments(name, arguments).empty() ||
          n_cells(name, arguments) > quickly_made)
        return {};
      try
      {
        dealii::Triangulation<3> mesh;
        dealii::GridGenerator::generate_from_name_and_arguments(mesh, name, arguments_for_deal_ii(name, arguments));
        const auto ids = mesh.get_boundary_ids();
        return std::set<unsigned int>(ids.begin(), ids.end());
      }
      catch (const std::exception &)
      {
        return {};
      }
    }
  } // namespace Generators
} // namespace Nodus
