#ifndef nodus_tests_restart_sliding_block_h
#define nodus_tests_restart_sliding_block_h

// A block is pressed onto another one and dragged over it to and fro: stick, slip and accumulated slip depend on the
// path.

#include "../cases.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace SlidingBlock
{
  using namespace Cases;

  inline Parameters parameters(const std::string &results_folder)
  {
    Parameters p;
    p.bodies = {box("lower", "5,3,1", {0, 0, 0}, {2, 1, 0.5}, 100, 0.3),
                box("upper", "3,2,2", {0.3, 0.1, 0.5}, {1.3, 0.9, 1.}, 80, 0.3)};
    for (auto &body : p.bodies)
      body.material.law = MaterialParameters::Law::neo_hookean;
    p.boundary_conditions         = {hold("bottom", region(1, {z_minus}), {0, 1, 2}),
                                     condition("top",
                                       BoundaryConditionParameters::Type::displacement,
                                       region(2, {z_plus}),
                                       {0, 1, 2},
                                       {"0.12*sin(3*t)", "0.02*t", "-0.02*min(2*t,1)"})};
    p.contact_pairs               = {pair(region(2, {z_minus}), region(1, {z_plus}), 0.3)};
    p.load_stepping.interval_ends = {0.5, 1.};
    p.load_stepping.increments    = {3, 5};
    p.output.results_folder       = results_folder;
    return p;
  }

  /// The upper block is rigid, pressed by a force and tilted by moments.
  inline Parameters driven(const std::string &results_folder)
  {
    Parameters p = parameters(results_folder);
    auto      &b = p.bodies[1];
    b.material   = MaterialParameters();
    b.rigid      = true;
    b.rigid_free = {2, 3, 4};
    p.boundary_conditions.pop_back();
    p.contact_pairs          = {pair(region(1, {z_plus}), region(2, {z_minus}), 0.3)};
    b.motion.translation     = {"0.12*sin(3*t)", "0.02*t", "0"};
    b.motion.rotation_centre = {0.8, 0.5, 0.5};
    b.rigid_force            = {"0", "0", "-min(2*t,1)"};
    b.rigid_moment           = {"0.03*t", "0.05*t", "0"};
    return p;
  }

  /// Instead of the upper block a plane.
  inline Parameters under_driven_plane(const std::string &results_folder)
  {
    Parameters p                            = driven(results_folder);
    p.bodies[1].generator                   = "";
    p.bodies[1].generator_arguments         = "";
    p.contact_pairs[0].master.boundary_ids  = {};
    p.contact_pairs[0].master_surface.shape = MasterSurfaceParameters::Shape::plane;
    p.contact_pairs[0].master_surface.point = Point(0., 0., 0.5);
    p.contact_pairs[0].master_surface.axis  = Vector3({0., 0., -1.});
    return p;
  }

  struct Outcome
  {
    std::vector<std::pair<double, std::vector<double>>> groups; ///< scale and values of one kind
    std::vector<double>                                 times;
  };

  /// Fields of the slave surface in the order of the positions, and resultants. Collective.
  inline Outcome outcome(ContactProblem &problem, const std::vector<double> &times)
  {
    const auto                                                &f = problem.contact_fields()[0];
    std::map<std::tuple<double, double, double>, unsigned int> order;
    for (unsigned int k = 0; k < f.X.size(); ++k)
      order[{f.X[k][0], f.X[k][1], f.X[k][2]}] = k;
    std::vector<double> stresses, lengths, forces;
    for (const auto &[X, k] : order)
    {
      stresses.insert(stresses.end(), {f.pressure[k], f.shear[0][k], f.shear[1][k]});
      lengths.insert(lengths.end(), {f.slip[0][k], f.slip[1][k], f.gap[k]});
      for (unsigned int c = 0; c < dim; ++c)
        lengths.push_back(f.displacement[k][c]);
    }
    for (unsigned int c = 0; c < dim; ++c)
      forces.push_back(problem.contact_resultants()[0].slave_force[c]);
    for (const RigidBodyMotion &body : problem.rigid_bodies())
      for (unsigned int c = 0; c < dim; ++c)
      {
        lengths.insert(lengths.end(), {body.translation[c], body.rotation[c]});
        forces.insert(forces.end(), {body.force[c], body.moment[c]});
      }
    Outcome result{{}, times};
    for (const auto &values : {stresses, lengths, forces})
    {
      double scale = 0.;
      for (const double v : values)
        scale = std::max(scale, std::abs(v));
      result.groups.emplace_back(scale, values);
    }
    return result;
  }

  /// Of contact on the slave at the end.
  inline Vector3 force(const Outcome &a)
  {
    const std::vector<double> &forces = a.groups[2].second;
    return Vector3({forces[0], forces[1], forces[2]});
  }

  /// Largest difference of any kind of value, relative to the largest value of that kind.
  inline double difference(const Outcome &a, const Outcome &b)
  {
    double largest = 0.;
    for (unsigned int g = 0; g < a.groups.size(); ++g)
      for (unsigned int i = 0; i < a.groups[g].second.size(); ++i)
        largest = std::max(largest, std::abs(a.groups[g].second[i] - b.groups[g].second[i]) / b.groups[g].first);
    if (std::getenv("NODUS_TEST_LOG") != nullptr && root())
      std::cout << "    difference " << largest << std::endl;
    return largest;
  }
} // namespace SlidingBlock

#endif
