#ifndef nodus_tests_contact_driven_body_h
#define nodus_tests_contact_driven_body_h

// What tests of rigid bodies that forces and moments drive share.

#include "../cases.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace Cases
{
  /// Moment about @p centre of a force and its moment about the origin.
  inline Vector3 moment_about(const Point &centre, const Vector3 &moment, const Vector3 &force)
  {
    return moment - dealii::cross_product_3d(Vector3(centre), force);
  }

  /// Expressions that reach @p v at t = 1 and later.
  inline std::vector<std::string> ramp(const Vector3 &v)
  {
    std::vector<std::string> expressions;
    for (unsigned int c = 0; c < dim; ++c)
    {
      std::ostringstream expression;
      expression << std::setprecision(17) << v[c] << "*t";
      expressions.push_back(expression.str());
    }
    return expressions;
  }

  /// Force residuals of the first geometry pass of the last increment square from one iteration to the next.
  inline bool is_quadratic(const std::string &folder)
  {
    MPI_Barrier(world());
    std::ifstream       stream(folder + "/convergence.csv");
    std::vector<double> residuals;
    double              increment = 0.;
    std::string         line;
    std::getline(stream, line);
    while (std::getline(stream, line))
    {
      std::vector<double> row;
      std::istringstream  cells(line);
      for (std::string cell; std::getline(cells, cell, ',');)
        row.push_back(std::stod(cell));
      if (row[0] != increment)
        residuals.clear();
      increment = row[0];
      if (row[3] == 1.)
        residuals.push_back(row[7]);
    }
    bool quadratic = residuals.size() > 3;
    for (unsigned int i = 2; i < residuals.size(); ++i) // the first correction takes up the load
      quadratic = quadratic && residuals[i] < 10. * residuals[i - 1] * residuals[i - 1] + 1e-11;
    return quadratic;
  }
} // namespace Cases

#endif
