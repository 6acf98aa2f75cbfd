#ifndef nodus_tests_cases_h
#define nodus_tests_cases_h

// Parameters of small cases built in code, and comparison with reference values.

#include <nodus/parameters/parameters.h>
#include <nodus/run/contact_problem.h>

#include "numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace Cases
{
  using namespace Nodus;

  /// Sides of a generated box.
  enum Side : unsigned int
  {
    x_minus,
    x_plus,
    y_minus,
    y_plus,
    z_minus,
    z_plus
  };

  inline std::string text(const Point &p)
  {
    std::ostringstream s;
    s << std::setprecision(16) << p[0] << "," << p[1] << "," << p[2];
    return s.str();
  }

  inline BodyParameters box(const std::string &name,
                            const std::string &cells,
                            const Point       &lower,
                            const Point       &upper,
                            const double       E,
                            const double       nu)
  {
    BodyParameters body;
    body.name                    = name;
    body.generator               = "subdivided_hyper_rectangle";
    body.generator_arguments     = cells + " : " + text(lower) + " : " + text(upper) + " : true";
    body.material.law            = MaterialParameters::Law::linear_elastic;
    body.material.youngs_modulus = E;
    body.material.poissons_ratio = nu;
    return body;
  }

  inline RegionParameters
  region(const unsigned int body, const std::vector<unsigned int> &ids, const std::string &where = "")
  {
    RegionParameters r;
    if (body > 0)
      r.bodies = {body};
    r.boundary_ids.assign(ids.begin(), ids.end());
    r.where = where;
    return r;
  }

  inline BoundaryConditionParameters condition(const std::string                      &name,
                                               const BoundaryConditionParameters::Type type,
                                               const RegionParameters                 &where,
                                               const std::vector<unsigned int>        &components,
                                               const std::vector<std::string>         &value)
  {
    BoundaryConditionParameters c;
    c.name       = name;
    c.type       = type;
    c.region     = where;
    c.components = components;
    c.value      = value;
    return c;
  }

  inline BoundaryConditionParameters
  hold(const std::string &name, const RegionParameters &where, const std::vector<unsigned int> &components)
  {
    return condition(name,
                     BoundaryConditionParameters::Type::displacement,
                     where,
                     components,
                     std::vector<std::string>(components.size(), "0"));
  }

  inline BoundaryConditionParameters
  drive(const std::string &name, const RegionParameters &where, const unsigned int component, const std::string &value)
  {
    return condition(name, BoundaryConditionParameters::Type::displacement, where, {component}, {value});
  }

  inline BoundaryConditionParameters
  press(const std::string &name, const RegionParameters &where, const std::string &value)
  {
    return condition(name, BoundaryConditionParameters::Type::pressure, where, {}, {value});
  }

  /// Nodal scheme on the facets as they are, which most reference values are for.
  inline ContactPairParameters
  pair(const RegionParameters &slave, const RegionParameters &master, const double friction = 0.)
  {
    ContactPairParameters p;
    p.name                 = "pair";
    p.slave                = slave;
    p.master               = master;
    p.friction_coefficient = friction;
    p.scheme               = ContactPairParameters::Scheme::nodal;
    p.surface              = ContactPairParameters::Surface::faceted;
    p.normal               = ContactPairParameters::Normal::master_facet;
    return p;
  }

  /// Three nested loops around Newton, none merged into it.
  inline void use_loops(Parameters &p)
  {
    for (LoopParameters *loop : {&p.geometry_loop, &p.threshold_loop, &p.status_loop})
      loop->mode = LoopParameters::Mode::fixed_point;
  }

  /// Runs with results in a folder named after the test; the log is dropped unless the environment asks for it.
  inline MPI_Comm world()
  {
    return MPI_COMM_WORLD;
  }
  inline std::ostream &log()
  {
    static std::ostringstream dropped;
    return std::getenv("NODUS_TEST_LOG") != nullptr ? std::cout : dropped;
  }

  inline bool root()
  {
    int rank;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank == 0;
  }

  /// A line "what: text" of the first rank.
  inline void report(const std::string &what, const std::string &text)
  {
    if (root())
      std::cout << what << ": " << text << std::endl;
  }

  /// Prints @p value, as it is against @p reference within @p tolerance, relative to @p scale (the reference itself
  /// when 0), and "NO" when it is not.
  inline void check(const std::string &what,
                    const double       value,
                    const double       reference,
                    const double       tolerance,
                    const double       scale = 0.)
  {
    if (root() && std::getenv("NODUS_TEST_LOG") != nullptr)
      std::cout << "    " << std::setprecision(10) << value << " deviation "
                << std::abs(value - reference) / (scale > 0. ? scale : std::abs(reference)) << std::endl;
    report(what, Numbers::comparison(value, reference, tolerance, scale));
  }

  inline void check(const std::string &what, const bool holds)
  {
    report(what, holds ? "yes" : "NO");
  }

  /// The components of a vector, all to the same digit; the tolerance is relative to the length of the reference.
  inline void check(const std::string &what, const Vector3 &value, const Vector3 &reference, const double tolerance)
  {
    const double       size = reference.norm(), difference = (value - reference).norm();
    const bool         holds = difference <= tolerance * size, snap = tolerance <= Numbers::tight;
    std::ostringstream text;
    for (unsigned int c = 0; c < dim; ++c)
      text << (holds ? Numbers::number(snap ? reference[c] : value[c], 5, size) : Numbers::plain(value[c], 10)) << ' ';
    text << "(as the reference, within " << tolerance;
    if (holds)
      text << (snap ? "" : ", off by " + Numbers::small(difference / size)) << ')';
    else
      text << "), deviation " << difference / size << ": NO";
    report(what, text.str());
  }

  /// Prints a number that does not depend on round-off, and "NO" when it is above @p bound.
  inline void check_count(const std::string &what, const unsigned int count, const unsigned int bound)
  {
    report(what, std::to_string(count) + " (at most " + std::to_string(bound) + (count <= bound ? ")" : "): NO"));
  }

  /// Prints a number that has to be @p reference, and "NO" when it is not.
  inline void check_equal(const std::string &what, const unsigned int count, const unsigned int reference)
  {
    report(what,
           std::to_string(count) + (count == reference ? "" : " (reference " + std::to_string(reference) + "): NO"));
  }

  /// The one of @p values that is farthest from @p reference.
  inline double farthest(const std::vector<double> &values, const double reference)
  {
    return *std::max_element(values.begin(),
                             values.end(),
                             [reference](const double a, const double b)
                             { return std::abs(a - reference) < std::abs(b - reference); });
  }

  /// Prints an error that the discretisation leaves, with @p digits, and "NO" when it is above @p bound.
  inline void check_error(const std::string &what, const double error, const double bound, const int digits = 3)
  {
    report(what, Numbers::error_below(error, bound, digits));
  }

  /// The last number in the column of energy.csv whose title begins with @p title.
  inline double last_energy(const std::string &folder, const std::string &title)
  {
    std::ifstream file(folder + "/energy.csv");
    std::string   line, last, cell;
    std::getline(file, line);
    std::istringstream titles(line);
    unsigned int       column = 0;
    while (std::getline(titles, cell, ',') && cell.compare(0, title.size(), title) != 0)
      ++column;
    while (std::getline(file, line))
      last = line;
    std::istringstream cells(last);
    for (unsigned int i = 0; i <= column; ++i)
      std::getline(cells, cell, ',');
    return std::stod(cell);
  }

  /// Index of the slave node of a pair at a reference position.
  inline unsigned int node_at(const ContactFields &fields, const Point &X)
  {
    for (unsigned int k = 0; k < fields.X.size(); ++k)
      if (fields.X[k].distance(X) < 1e-9 * (1. + X.norm()))
        return k;
    throw std::runtime_error("no slave node at " + text(X));
  }
} // namespace Cases

#endif
