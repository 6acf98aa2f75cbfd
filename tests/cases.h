#ifndef nodus_tests_cases_h
#define nodus_tests_cases_h

// Parameters of small cases built in code, and comparison with reference values.

#include <nodus/parameters/parameters.h>
#include <nodus/run/contact_problem.h>

#include <cmath>
#include <cstdlib>
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
    r.body = body;
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

  /// Prints "ok" or the deviation: @p value against @p reference, relative to @p scale (the reference itself when 0).
  inline void check(const std::string &what,
                    const double       value,
                    const double       reference,
                    const double       tolerance,
                    const double       scale = 0.)
  {
    const double deviation = std::abs(value - reference) / (scale > 0. ? scale : std::abs(reference));
    if (!root())
      return;
    if (std::getenv("NODUS_TEST_LOG") != nullptr)
      std::cout << "    " << std::setprecision(10) << value << " deviation " << deviation << std::endl;
    std::cout << what << ": reference " << std::setprecision(9) << reference << " within " << tolerance << ": ";
    if (deviation <= tolerance)
      std::cout << "yes" << std::endl;
    else
      std::cout << "NO, value " << std::setprecision(10) << value << ", deviation " << deviation << std::endl;
  }

  inline void check(const std::string &what, const bool holds)
  {
    if (root())
      std::cout << what << ": " << (holds ? "yes" : "NO") << std::endl;
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
