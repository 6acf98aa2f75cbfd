// Mean values over consistent weights (eq. W2) by the rules that a pair may choose, on one slave face of 2 x 1: the
// nodal field (1 + x + x^2) (1 - y + y^2), interpolated, against its exact mean products with the shape functions,
// whose mass matrix is a product of those of a line. Rules of sufficient degree are exact; the trapezoid rule has its
// points at the nodes, where the mean of a field is the nodal value itself: it differs as given.

#include "../contact_fixture.h"

using namespace Cases;

namespace
{
  /// (M f)_j / m_j on a line of length 1, f at its equidistant nodes.
  std::vector<double> exact_means(const std::vector<double> &f)
  {
    if (f.size() == 2)
      return {(2. * f[0] + f[1]) / 3., (f[0] + 2. * f[1]) / 3.};
    return {(4. * f[0] + 2. * f[1] - f[2]) / 5.,
            (2. * f[0] + 16. * f[1] + 2. * f[2]) / 20.,
            (-f[0] + 2. * f[1] + 4. * f[2]) / 5.};
  }

  double along_x(const double x)
  {
    return 1. + x + x * x;
  }

  double along_y(const double y)
  {
    return 1. - y + y * y;
  }

  /// Exact mean at coordinate @p c of a line from 0 to @p length with the field @p f.
  double exact_mean(double (*f)(double), const double length, const double c, const unsigned int degree)
  {
    std::vector<double> nodal;
    for (unsigned int i = 0; i <= degree; ++i)
      nodal.push_back(f(length * i / degree));
    return exact_means(nodal)[std::lround(c / length * degree)];
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Rule = ContactPairParameters::QuadratureRule;
  struct Choice
  {
    const char  *name;
    Rule         rule;
    unsigned int points[2]; // for degree 1 and 2
  };
  for (const unsigned int degree : {1u, 2u})
    for (const Choice &choice : {Choice{"automatic", Rule::gauss, {0, 0}},
                                 Choice{"Gauss", Rule::gauss, {2, 3}},
                                 Choice{"Gauss, more", Rule::gauss, {4, 5}},
                                 Choice{"Simpson", Rule::simpson, {3, 3}},
                                 Choice{"Newton-Cotes", Rule::newton_cotes, {4, 5}},
                                 Choice{"Newton-Cotes, least", Rule::newton_cotes, {2, 3}}})
    {
      ContactPairParameters p = pair(region(2, {z_minus}), region(1, {z_plus}));
      p.weights               = ContactPairParameters::Weights::consistent;
      p.quadrature_rule       = choice.rule;
      p.quadrature_points     = choice.points[degree - 1];
      const ContactFixture fixture(
          {box("lower", "1,1,1", {0, 0, 0}, {2, 1, 1}, 1, 0), box("upper", "1,1,1", {0, 0, 1}, {2, 1, 2}, 1, 0)},
          {p},
          degree);
      const auto         &slaves = fixture.surfaces->slave_nodes();
      std::vector<double> f, exact;
      for (const auto &slave : slaves)
      {
        const Point &X = fixture.surfaces->nodes()[slave.node].X;
        f.push_back(along_x(X[0]) * along_y(X[1]));
        exact.push_back(exact_mean(along_x, 2., X[0], degree) * exact_mean(along_y, 1., X[1], degree));
      }
      const std::vector<double> means = fixture.weights.weighted(f);
      double                    area = 0., deviation = 0.;
      for (unsigned int k = 0; k < slaves.size(); ++k)
      {
        area += fixture.weights.area()[k];
        deviation = std::max(deviation, std::abs(means[k] - exact[k]));
      }
      std::cout << "Q" << degree << ", " << choice.name << ": " << fixture.weights.points().size() << " points, area "
                << Numbers::number(area) << ", largest deviation of a mean " << Numbers::small(deviation) << std::endl;
    }
}
