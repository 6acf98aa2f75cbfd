#ifndef nodus_tests_bolted_joint_h
#define nodus_tests_bolted_joint_h

// A bolt of two halves and a sleeve beside it, both on the ground, under a rigid head that the bolt is tied to. Without
// Poisson's ratio all of it are bars: what the preload does is known in closed form.

#include "cases.h"

namespace BoltedJoint
{
  using namespace Cases;

  constexpr double E_bolt = 1000., E_sleeve = 50., length = 4.;
  /// Of areas 1 and 16: the sleeve is too stout to buckle.
  constexpr double k_bolt = E_bolt / length, k_sleeve = 16. * E_sleeve / length;
  constexpr double force = 20.; ///< of the preload

  /// The pairs of the joint; the first is the section.
  enum Pair : unsigned int
  {
    section,
    bolt_on_head,
    sleeve_on_head
  };

  inline ContactPairParameters tied(const RegionParameters &slave, const RegionParameters &master)
  {
    ContactPairParameters p;
    p.slave       = slave;
    p.master      = master;
    p.contact_law = ContactPairParameters::ContactLaw::tied;
    return p;
  }

  /// Expression of a force along the direction of the axes of the mesh that @p joint is turned by (turn_joint).
  struct Turn
  {
    Vector3 axis;
    double  angle = 0.; ///< degrees
    Vector3 of(const Vector3 &v) const
    {
      if (angle == 0.)
        return v;
      const Vector3 n = axis / axis.norm();
      const double  a = angle * dealii::numbers::PI / 180.;
      return std::cos(a) * v + std::sin(a) * dealii::cross_product_3d(n, v) + (1. - std::cos(a)) * (n * v) * n;
    }
  };

  /// Tightened in the first interval, locked and loaded by @p service along the bolt in the second.
  inline Parameters joint(const std::string &folder, const std::string &service, const Turn &turn = Turn())
  {
    Parameters p;
    p.bodies             = {box("lower half", "2,2,2", {0, 0, 0}, {1, 1, 2}, E_bolt, 0.),
                            box("upper half", "3,2,2", {0, 0, 2}, {1, 1, 4}, E_bolt, 0.),
                            box("sleeve", "3,2,3", {2, -1.5, 0}, {6, 2.5, 4}, E_sleeve, 0.),
                            box("head", "5,3,1", {0, -1.5, 4}, {6, 2.5, 5}, 0, 0)};
    p.bodies[3].material = MaterialParameters();
    p.bodies[3].rigid    = true;
    // across the bolt it is held, by what turns with it
    p.bodies[3].rigid_free = turn.angle == 0. ? std::vector<unsigned int>{2} : std::vector<unsigned int>{0, 1, 2};
    p.bodies[3].motion.rotation_centre = {0., 0., 0.};
    const Vector3 along                = turn.of(Vector3({0, 0, 1}));
    for (unsigned int c = 0; c < dim; ++c)
      p.bodies[3].rigid_force[c] = Numbers::plain(along[c], 17) + "*(" + service + ")";
    for (auto &body : p.bodies)
    {
      body.rotation_axis  = turn.angle == 0. ? Vector3() : turn.axis;
      body.rotation_angle = turn.angle;
    }
    p.boundary_conditions         = {hold("ground of the bolt", region(1, {z_minus}), {0, 1, 2}),
                                     hold("ground of the sleeve", region(3, {z_minus}), {0, 1, 2})};
    p.contact_pairs               = {tied(region(1, {z_plus}), region(2, {z_minus})),
                                     tied(region(2, {z_plus}), region(4, {z_minus})),
                                     ContactPairParameters()};
    p.contact_pairs[2].slave      = region(3, {z_plus});
    p.contact_pairs[2].master     = region(4, {z_minus});
    p.contact_pairs[0].name       = "bolt";
    p.contact_pairs[0].preload    = {Numbers::plain(force, 17) + "*min(t,1)", 1., {}};
    p.load_stepping.interval_ends = {1., 2.};
    p.load_stepping.increments    = {2, 4};
    p.output.results_folder       = folder;
    p.output.write_vtu            = false;
    return p;
  }
} // namespace BoltedJoint

#endif
