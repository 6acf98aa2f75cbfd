// Curved surfaces that do not match and slide past each other by half a face, so that ranks meet master faces of
// other ranks than at first: a ring shrinks on another one, which then turns by 0.24 in four increments. Forces,
// tractions and statuses are the same on every number of ranks; the last column depends on how the pressures are spread
// over the surface.

#include "../cases.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  BodyParameters ring(const std::string &name, const double inner, const double outer, const unsigned int cells)
  {
    BodyParameters     body;
    std::ostringstream arguments;
    arguments << "0.4 : " << inner << " : " << outer << " : " << cells << " : 1";
    body.name                    = name;
    body.generator               = "cylinder_shell";
    body.generator_arguments     = arguments.str();
    body.material.law            = MaterialParameters::Law::neo_hookean;
    body.material.youngs_modulus = 1000;
    body.material.poissons_ratio = 0.3;
    return body;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Scheme      = ContactPairParameters::Scheme;
  using Integration = ContactPairParameters::Integration;
  using Weights     = ContactPairParameters::Weights;
  struct Kind
  {
    std::string name;
    Scheme      scheme;
    Integration integration;
    Weights     weights;
  };
  const Kind kinds[] = {{"nodal", Scheme::nodal, Integration::face, Weights::nodal_quadrature},
                        {"nodal, consistent", Scheme::nodal, Integration::face, Weights::consistent},
                        {"averaged, face", Scheme::averaged, Integration::face, Weights::nodal_quadrature},
                        {"averaged, segment", Scheme::averaged, Integration::segment, Weights::nodal_quadrature},
                        {"integration point", Scheme::integration_point, Integration::face, Weights::nodal_quadrature}};

  for (const unsigned int degree : {1u, 2u})
    for (const auto &kind : kinds)
    {
      if (degree == 2 && (kind.name == "nodal" || kind.name == "averaged, face"))
        continue;
      Parameters p;
      p.degree = degree;
      p.bodies = {ring("outer", 1., 1.3, degree == 1 ? 20 : 12), ring("inner", 0.7, 1., degree == 1 ? 16 : 10)};
      const auto displacement = BoundaryConditionParameters::Type::displacement;
      p.boundary_conditions   = {condition("shrink",
                                         displacement,
                                         region(1, {0}, "x^2+y^2 > 1.6"),
                                         {0, 1},
                                         {"-0.02*min(t,1)*x", "-0.02*min(t,1)*y"}),
                                 condition("turn",
                                         displacement,
                                         region(2, {0}, "x^2+y^2 < 0.6"),
                                         {0, 1},
                                         {"x*(cos(0.24*max(t-1,0))-1)-y*sin(0.24*max(t-1,0))",
                                            "y*(cos(0.24*max(t-1,0))-1)+x*sin(0.24*max(t-1,0))"}),
                                 hold("plane", region(0, {0}), {2})};
      p.contact_pairs         = {pair(region(2, {0}, "x^2+y^2 > 0.9"), region(1, {0}, "x^2+y^2 < 1.1"), 0.2)};
      auto &contact           = p.contact_pairs[0];
      contact.scheme          = kind.scheme;
      contact.integration     = kind.integration;
      contact.weights         = kind.weights;
      contact.surface         = ContactPairParameters::Surface::smoothed;
      contact.normal          = ContactPairParameters::Normal::averaged;
      p.load_stepping         = {{1., 2.}, {1, 4}};
      p.output.vtu_interval   = 0;
      p.output.results_folder = "distributed_search_results";

      ContactProblem problem(p, world(), log());
      problem.run();
      const auto &r      = problem.contact_resultants()[0];
      const auto &f      = problem.contact_fields()[0];
      double      normal = 0., spread = 0., slip = 0.;
      for (unsigned int k = 0; k < f.X.size(); ++k)
      {
        normal += f.area[k] * f.pressure[k];
        spread += f.area[k] * f.pressure[k] * 1e-3 * f.pressure[k] * (2. + f.X[k][0] * f.X[k][1] + f.X[k][2]);
        slip += f.area[k] * f.slip[0][k];
      }
      if (root())
        std::cout << "Q" << degree << ", " << kind.name << ": torque " << std::setprecision(6) << r.slave_moment[2]
                  << ", normal " << normal << ", slip " << slip << ", open " << r.open << ", slip " << r.slip
                  << ", stick " << r.stick << ", spread " << spread << std::endl;
    }
}
