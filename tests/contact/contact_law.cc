// The law of a contact point alone, without mesh. Central differences of the residual against the tangent and against
// the derivative with respect to the threshold, 1e-8 relative, in every status and for every kind of point; residual
// and tangent of a point with one node in numbers; values that theory states: Coulomb's limit, Signorini's conditions.

#include "../cases.h"

#include "contact/contact_law.h"

#include <deal.II/base/mpi.h>

#include <functional>

using namespace Cases;

namespace
{
  constexpr double slip_augmentation = 4.; ///< h_tau times the friction limit: the traction per slip [pressure/length]

  struct Kind
  {
    std::string  name;
    unsigned int n_nodes, n_jumps;
  };

  /// One status for all nodes, or those of `mixed` in turn.
  const LawStatus open{false, false, true}, frictionless{true, false, true}, stick{true, true, true},
      slip{true, true, false};
  const std::vector<LawStatus> mixed{slip, stick, open, frictionless};

  struct Case
  {
    std::string                     name;
    std::vector<LawStatus>          status;
    double                          size = 1.; ///< of Lambda and slips: below 1/2 they stay inside of the unit ball
    bool                            in_the_mean = false, held = false;
    std::function<void(LawFrame &)> change    = [](LawFrame &) {};
    bool                            compliant = false; ///< a linear pressure-gap law and elastic slip
  };

  /// Numbers between -1 and 1 that are the same everywhere.
  double number(const unsigned int i)
  {
    return std::sin(1. + 7.3 * i + 0.1 * i * i);
  }

  Vector3 numbers(const unsigned int i)
  {
    return Vector3({number(i), number(i + 1), number(i + 2)});
  }

  LawFrame frame(const unsigned int i)
  {
    LawFrame f;
    f.normal     = Vector3({0.2 * number(i), 0.2 * number(i + 1), 1.});
    f.tangent[0] = Vector3({1., 0.3 * number(i + 2), 0.});
    f.normal /= f.normal.norm();
    f.tangent[0] -= (f.tangent[0] * f.normal) * f.normal;
    f.tangent[0] /= f.tangent[0].norm();
    f.tangent[1]   = dealii::cross_product_3d(f.normal, f.tangent[0]);
    f.tangent_free = {{true, true}};
    return f;
  }

  /// The friction limit of the point moves its augmentation, too.
  void set_threshold(LawPoint &point, const double threshold)
  {
    point.threshold               = threshold;
    point.tangential_augmentation = slip_augmentation / -threshold;
  }

  LawPoint make(const Kind &kind, const Case &what)
  {
    LawPoint point;
    point.n_nodes             = kind.n_nodes;
    point.n_jumps             = kind.n_jumps;
    point.weight              = 0.6;
    point.normal_augmentation = 7.;
    point.in_the_mean         = what.in_the_mean;
    point.held                = what.held;
    point.linearise_threshold = true;
    point.compliance          = what.compliant ? 0.3 : 0.;
    point.elastic_slip        = what.compliant ? 0.2 : 0.;
    set_threshold(point, -2.5);
    const auto status = [&](const unsigned int a)
    { return what.status[kind.n_jumps < kind.n_nodes ? 0 : a % what.status.size()]; };
    for (unsigned int a = 0; a < kind.n_nodes; ++a)
    {
      // shape functions are positive and negative, their sum is one
      const double phi   = kind.n_nodes == 1 ? 1. : a == 0 ? 1.2 - 0.1 * kind.n_nodes : a == 1 ? -0.1 : 0.1;
      const double shape = kind.n_nodes == 1 ? 1. : phi + (a < 2 ? 0.05 : 0.);
      point.nodes[a]     = {status(a), frame(10 * a), shape, -3. + number(a + 3), {}, {}};
      // all friction points the same way, more or less, so that |w| is known to be large or small
      point.nodes[a].Lambda = {{what.size * (1.4 + 0.2 * number(a)), what.size * (0.5 + 0.2 * number(a + 1))}};
      if (what.compliant)
        point.nodes[a].elastic_slip = what.size * (Vector3({0.12, -0.07, 0.02}) + 0.02 * numbers(5 * a));
      what.change(point.nodes[a].frame);
    }
    for (unsigned int a = 0; a < kind.n_jumps; ++a)
    {
      const double shape = kind.n_jumps < kind.n_nodes ? 1. : point.nodes[a].shape;
      point.jumps[a]     = {status(a), frame(10 * a + 5), shape, 0.1 * number(a), {}};
      point.jumps[a].slip =
          what.size * (Vector3({0.25, 0.1, 0.}) + 0.02 * numbers(3 * a)) + 0.1 * point.jumps[a].frame.normal;
      what.change(point.jumps[a].frame);
    }
    return point;
  }

  void law(LawPoint point, LawSum &sum)
  {
    point.overclosure = 0.;
    for (unsigned int a = 0; a < point.n_nodes; ++a)
      if (point.nodes[a].status.contact)
        point.overclosure -= point.compliance * point.nodes[a].shape * point.nodes[a].lambda;
    sum.reset(point.n_jumps, point.n_nodes);
    add_contact_law(point, sum);
  }

  void move(LawPoint &point, const unsigned int unknown, const double step)
  {
    if (unknown < 3 * point.n_jumps)
    {
      LawJump &jump = point.jumps[unknown / 3];
      jump.distance += jump.frame.normal[unknown % 3] * step;
      jump.slip[unknown % 3] += step;
      return;
    }
    const unsigned int i    = unknown - 3 * point.n_jumps;
    LawNode           &node = point.nodes[i / 3];
    (i % 3 == 0 ? node.lambda : node.Lambda[i % 3 - 1]) += step;
  }

  /// Central difference of the residual along a change of the point.
  std::vector<double> difference(const LawPoint &point, const std::function<void(LawPoint &, double)> &change)
  {
    static LawSum       sum;
    const double        step = 1e-5;
    std::vector<double> result;
    for (const double sign : {1., -1.})
    {
      LawPoint moved = point;
      change(moved, sign * step);
      law(moved, sum);
      result.resize(sum.n_unknowns(), 0.);
      for (unsigned int i = 0; i < result.size(); ++i)
        result[i] += sign * sum.residual[i] / (2 * step);
    }
    return result;
  }

  bool is_friction_row(const LawPoint &point, const unsigned int i)
  {
    return i >= 3 * point.n_jumps && (i - 3 * point.n_jumps) % 3 > 0;
  }

  double tangent_error(const LawPoint &point, const LawSum &sum)
  {
    double worst = 0., largest = 0.;
    for (unsigned int j = 0; j < sum.n_unknowns(); ++j)
    {
      // a friction multiplier that is held does not move
      if (point.held && is_friction_row(point, j))
        continue;
      const auto column = difference(point, [&](LawPoint &p, const double step) { move(p, j, step); });
      for (unsigned int i = 0; i < sum.n_unknowns(); ++i)
      {
        largest = std::max(largest, std::abs(sum.tangent(i, j)));
        worst   = std::max(worst, std::abs(sum.tangent(i, j) - column[i]));
      }
    }
    return worst / largest;
  }

  /// The factor mu lambda_s of the stick rows and mu lambda_s / h_tau of the slip rows is not derived, but for the
  /// regularised law of points of several nodes. @p rate: of the threshold.
  template <typename Column>
  void leave_out_factors(const LawPoint &point, const LawSum &sum, const double rate, Column &column)
  {
    if (point.n_nodes > 1 && point.in_the_mean)
      return;
    for (unsigned int a = 0; a < point.n_nodes; ++a)
      for (unsigned int i = 0; i < 2; ++i)
        if (const LawNode &node = point.nodes[a]; node.status.friction && node.frame.tangent_free[i])
        {
          const unsigned int row = sum.first_node + 3 * a + 1 + i;
          column[row] -= rate * (node.status.stick ? 1. : 2.) / point.threshold * sum.residual[row];
        }
  }

  /// The same of the derivative with respect to the threshold.
  double threshold_error(const LawPoint &point, const LawSum &sum)
  {
    const double threshold = point.threshold;
    auto         column    = difference(point,
                             [&](LawPoint &p, const double step)
                             {
                               set_threshold(p, threshold + step);
                               // one node that sticks keeps its traction, unless elastic slip gives Lambda
                               LawNode &node = p.nodes[0];
                               if (p.n_nodes == 1 && node.status.friction && node.status.stick && p.elastic_slip == 0.)
                                 for (unsigned int i = 0; i < 2; ++i)
                                   if (node.frame.tangent_free[i])
                                     node.Lambda[i] *= threshold / (threshold + step);
                             });
    leave_out_factors(point, sum, 1., column);
    double worst = 0.;
    for (unsigned int i = 0; i < sum.n_unknowns(); ++i)
      worst = std::max(worst, std::abs(sum.by_threshold[i] - column[i]));
    return worst;
  }

  /// A threshold that follows the pressures: mu sum of phi S lambda, as of points of an integration rule. The whole
  /// tangent in the columns of lambda is that of the law and what the threshold adds.
  double coupled_error(const LawPoint &original)
  {
    static LawSum sum;
    const double  mu        = 0.4;
    const auto    threshold = [&](const LawPoint &p)
    {
      double lambda = 0.;
      for (unsigned int a = 0; a < p.n_nodes; ++a)
        lambda += p.nodes[a].status.contact ? p.nodes[a].shape * p.nodes[a].lambda : 0.;
      return mu * lambda;
    };
    LawPoint point = original;
    set_threshold(point, threshold(point));
    law(point, sum);
    double worst = 0.;
    for (unsigned int a = 0; a < point.n_nodes; ++a)
    {
      const unsigned int j      = sum.first_node + 3 * a;
      auto               column = difference(point,
                               [&](LawPoint &p, const double step)
                               {
                                 move(p, j, step);
                                 set_threshold(p, threshold(p));
                               });
      const double       slope  = point.nodes[a].status.contact ? mu * point.nodes[a].shape : 0.;
      leave_out_factors(point, sum, slope, column);
      for (unsigned int i = 0; i < sum.n_unknowns(); ++i)
        worst = std::max(worst, std::abs(sum.tangent(i, j) + sum.by_threshold[i] * slope - column[i]));
    }
    return worst;
  }

  void print(const LawPoint &point, const LawSum &sum)
  {
    double residual = 0., tangent = 0., by_threshold = 0.;
    for (unsigned int i = 0; i < sum.n_unknowns(); ++i)
    {
      residual += (1. + 0.1 * i) * sum.residual[i];
      by_threshold += (1. + 0.1 * i) * sum.by_threshold[i];
      for (unsigned int j = 0; j < sum.n_unknowns(); ++j)
        tangent += (1. + 0.1 * i + 0.05 * j * i) * sum.tangent(i, j);
    }
    std::cout << std::fixed << std::setprecision(6);
    std::cout << "  weighted sums: residual " << residual << ", tangent " << tangent << ", by threshold "
              << by_threshold << std::endl;
    for (unsigned int i = 0; i < sum.n_unknowns() && point.n_nodes == 1; ++i)
    {
      std::cout << "  " << std::setw(10) << sum.residual[i] << " |";
      for (unsigned int j = 0; j < sum.n_unknowns(); ++j)
        std::cout << " " << std::setw(10) << sum.tangent(i, j);
      std::cout << " | " << std::setw(10) << sum.by_threshold[i] << std::endl;
    }
    std::cout << std::defaultfloat;
  }

  void compare(const Kind &kind, const Case &what)
  {
    static LawSum  sum;
    const LawPoint point = make(kind, what);
    law(point, sum);
    std::cout << kind.name << ", " << what.name << ":" << std::endl;
    print(point, sum);
    double asymmetry = 0.;
    for (unsigned int i = 0; i < sum.n_unknowns(); ++i)
      for (unsigned int j = 0; j < i; ++j)
        asymmetry = std::max(asymmetry, std::abs(sum.tangent(i, j) - sum.tangent(j, i)));
    check("  tangent to 1e-8", tangent_error(point, sum) < 1e-8);
    check("  symmetric to 1e-14", asymmetry < 1e-14);
    check("  by threshold to 1e-8", threshold_error(point, sum) < 1e-8);
    if (kind.n_nodes > 1)
      check("  coupled threshold to 1e-8", coupled_error(point) < 1e-8);
    if (what.held)
    {
      bool kept = true;
      for (unsigned int i = 0; i < sum.n_unknowns(); ++i)
        if (is_friction_row(point, i) && point.nodes[(i - sum.first_node) / 3].status.friction &&
            !point.nodes[(i - sum.first_node) / 3].status.stick)
        {
          kept = kept && std::abs(sum.residual[i]) < 1e-14;
          for (unsigned int j = 0; j < sum.first_node; ++j)
            kept = kept && sum.tangent(i, j) == 0.;
        }
      check("  held multipliers stay", kept);
    }
  }

  /// Force on the slave side over the area of the point.
  Vector3 traction(const LawPoint &point)
  {
    static LawSum sum;
    law(point, sum);
    Vector3 result;
    for (unsigned int a = 0; a < point.n_jumps; ++a)
      for (unsigned int c = 0; c < 3; ++c)
        result[c] -= sum.residual[3 * a + c] / point.weight;
    return result;
  }

  /// A node in the frame of the axes with pressure 10 and friction coefficient 0.3 that has moved by @p d.
  LawPoint node_at(const LawStatus &status, const Vector3 &d, const std::array<double, 2> &Lambda = {{0., 0.}})
  {
    LawFrame axes;
    axes.normal       = Vector3({0., 0., 1.});
    axes.tangent      = {{Vector3({1., 0., 0.}), Vector3({0., 1., 0.})}};
    axes.tangent_free = {{true, true}};
    LawPoint point;
    point.n_nodes = point.n_jumps = 1;
    point.nodes[0]                = {status, axes, 1., -10., Lambda, {}};
    point.jumps[0]                = {status, axes, 1., d[2], d};
    point.weight                  = 0.25;
    point.normal_augmentation     = 7.;
    set_threshold(point, 0.3 * -10.);
    return point;
  }

  void known_values()
  {
    std::cout << "Known values, pressure 10, friction coefficient 0.3:" << std::endl;
    static LawSum sum;
    const Vector3 d({0.6, -0.8, 0.01});

    Vector3 t = traction(node_at(open, d));
    check("  no traction where open", t.norm() == 0.);
    t = traction(node_at(frictionless, d));
    check("  the pressure pushes the slave away from the master", t[2], -10., 1e-12);
    check("  no friction without friction", std::hypot(t[0], t[1]) == 0.);

    // Coulomb: all that slips has the traction mu p against its motion, whatever the augmentation, and keeps it.
    for (const double factor : {2., 20., 2000.})
    {
      const LawPoint point = node_at(slip, factor * d);
      t                    = traction(point);
      check("  friction of slip", std::hypot(t[0], t[1]), 3., 1e-12);
      check("  and its x part, against the slip", t[0], -1.8, 1e-12);
      law(point, sum);
      double along = 0., across = 0.;
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int j = 0; j < 2; ++j)
        {
          along += d[i] * sum.tangent(i, j) * d[j] / point.weight;
          across += d[1 - i] * (i == 0 ? 1 : -1) * sum.tangent(i, j) * d[1 - j] * (j == 0 ? 1 : -1) / point.weight;
        }
      check("  no stiffness along the slip", along, 0., 1e-12, 3.);
      check("  mu p over the slip across it", across, 3. / factor, 1e-12);
    }
    // The direction that slips is that of Lambda + h_tau slip.
    t = traction(node_at(slip, 1e-9 * d, {{-3., 4.}}));
    check("  friction of slip that has just begun, x", t[0], 1.8, 1e-8);
    check("  y", t[1], -2.4, 1e-8);

    // Stick: the traction is mu lambda Lambda; the law is no slip.
    t = traction(node_at(stick, d, {{0.5, -0.25}}));
    check("  friction of stick, x", t[0], -1.5, 1e-12);
    check("  y", t[1], 0.75, 1e-12);
    law(node_at(stick, d, {{0.5, -0.25}}), sum);
    check("  law of stick: mu p weight slip, x", sum.residual[4], 3. * 0.25 * 0.6, 1e-12);
    check("  y", sum.residual[5], 3. * 0.25 * -0.8, 1e-12);
    check("  law of contact: - weight distance", sum.residual[3], -0.25 * 0.01, 1e-12);
    law(node_at(open, d), sum);
    check("  law of open nodes: - weight lambda / h_n", sum.residual[3], 0.25 * 10. / 7., 1e-12);

    // Slip that is on the sphere satisfies its law; inside of the ball the projection takes over.
    law(node_at(slip, Vector3(), {{0.6, -0.8}}), sum);
    check("  law of slip on the sphere", std::hypot(sum.residual[4], sum.residual[5]) < 1e-15);
    t = traction(node_at(slip, 0.1 * d, {{0.3, 0.}}));
    check("  friction inside of the ball, x", t[0], -3. * (0.3 + 4. / 3. * 0.06), 1e-12);
    check("  y", t[1], 3. * 4. / 3. * 0.08, 1e-12);

    // Elastic slip 1/2 and the pressure-gap law d = p/200: laws that hold, and what is missing where they do not.
    LawPoint layer              = node_at(stick, Vector3({0.1, 0., 0.07}), {{0.4, 0.}});
    layer.compliance            = 1. / 200.;
    layer.elastic_slip          = 0.5;
    layer.nodes[0].elastic_slip = Vector3({0.1, 0., 0.});
    law(layer, sum);
    check("  law of an overclosure that is p/200 and 0.02: - weight times that", sum.residual[3], -0.25 * 0.02, 1e-12);
    check("  law of elastic slip that is slip and what was there", std::abs(sum.residual[4]) < 1e-15);
    layer.nodes[0].Lambda = {{0.5, 0.}};
    law(layer, sum);
    check("  and of more: mu p weight times what is too much", sum.residual[4], 3. * 0.25 * -0.05, 1e-12);
    for (LawStatus *const status : {&layer.nodes[0].status, &layer.jumps[0].status})
      *status = slip;
    layer.jumps[0].slip   = Vector3({0.5, 0.4, 0.});
    layer.nodes[0].Lambda = {{0.6 / std::hypot(0.6, 0.4), 0.4 / std::hypot(0.6, 0.4)}};
    law(layer, sum);
    check("  slip goes along slip and elastic slip together", std::hypot(sum.residual[4], sum.residual[5]) < 1e-15);

    LawPoint mean    = node_at(stick, 2. * d);
    mean.in_the_mean = true;
    t                = traction(mean);
    check("  in the mean the pressure is p + h_n d_n", t[2], -10. - 7. * 0.02, 1e-12);
    check("  and what sticks slips beyond the limit", std::hypot(t[0], t[1]), 3., 1e-12);

    LawPoint held = node_at(slip, d, {{-0.6, -0.8}});
    held.held     = true;
    t             = traction(held);
    check("  held friction keeps its direction, x", t[0], 1.8, 1e-12);
    check("  y", t[1], 2.4, 1e-12);

    LawPoint orthotropic                      = node_at(slip, {Vector3({0., 5., 0.})});
    orthotropic.jumps[0].frame.friction_scale = {{1., 0.5}};
    check("  orthotropic friction along the second axis", traction(orthotropic)[1], -1.5, 1e-12);

    LawPoint fixed = node_at(slip, d);
    for (LawFrame *f : {&fixed.nodes[0].frame, &fixed.jumps[0].frame})
      f->tangent_free = {{false, true}};
    t = traction(fixed);
    check("  no friction along a void tangent", t[0] == 0.);
    check("  all of it along the other one", t[1], 3., 1e-12);

    // Tied: sticks with the stiffness of the bodies as threshold, in tension as well; its distance is without what is
    // adjusted.
    LawPoint tied        = node_at(stick, Vector3({0., 0., 0.}), {{0.001, 0.}});
    tied.nodes[0].lambda = 5.;
    set_threshold(tied, -2000.);
    t = traction(tied);
    check("  tied: pull", t[2], 5., 1e-12);
    check("  tied: shear", t[0], -2., 1e-12);
    law(tied, sum);
    check("  tied: laws", std::abs(sum.residual[3]) + std::hypot(sum.residual[4], sum.residual[5]) == 0.);

    // Nodes of different status do not see each other: the filtered fields stand on both sides of each product.
    LawPoint pair = node_at(stick, d, {{0.5, 0.}});
    pair.n_nodes = pair.n_jumps = 2;
    pair.nodes[1]               = pair.nodes[0];
    pair.jumps[1]               = pair.jumps[0];
    pair.nodes[1].status = pair.jumps[1].status = slip;
    for (unsigned int a = 0; a < 2; ++a)
      pair.nodes[a].shape = pair.jumps[a].shape = 0.5;
    law(pair, sum);
    double coupling = 0.;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int j = 0; j < 2; ++j)
        coupling = std::max({coupling,
                             std::abs(sum.tangent(i, sum.first_node + 4 + j)),
                             std::abs(sum.tangent(3 + i, sum.first_node + 1 + j)),
                             std::abs(sum.tangent(i, 3 + j))});
    check("  no friction between a node that sticks and one that slips", coupling == 0.);
    check("  weight of the threshold of stick, one node", threshold_weight(node_at(stick, d), 0) == 0.);
    check("  of slip, one node", threshold_weight(node_at(slip, d), 0), 1., 1e-12);
    check("  of stick among others", threshold_weight(pair, 0), 0.5, 1e-12);
    check("  of slip among others", threshold_weight(pair, 1), 0.5, 1e-12);
    check("  of frictionless contact", threshold_weight(node_at(frictionless, d), 0) == 0.);
    check("  where open", threshold_weight(node_at(open, d), 0) == 0.);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const auto        hold_first  = [](LawFrame &f) { f.tangent_free[0] = false; };
  const auto        hold_both   = [](LawFrame &f) { f.tangent_free = {{false, false}}; };
  const auto        orthotropic = [](LawFrame &f) { f.friction_scale = {{1., 0.4}}; };
  const Case        cases[]     = {{"open", {open}},
                                   {"frictionless", {frictionless}},
                                   {"stick", {stick}},
                                   {"slip", {slip}},
                                   {"slip inside of the ball", {slip}, 0.3},
                                   {"mixed", mixed, 2.},
                                   {"mixed, inside of the ball", mixed, 0.3},
                                   {"stick, one free tangent", {stick}, 1., false, false, hold_first},
                                   {"slip, one free tangent", {slip}, 1., false, false, hold_first},
                                   {"stick, no free tangent", {stick}, 1., false, false, hold_both},
                                   {"stick, orthotropic", {stick}, 1., false, false, orthotropic},
                                   {"slip, orthotropic", {slip}, 1., false, false, orthotropic},
                                   {"open, held", {open}, 1., false, true},
                                   {"stick, held", {stick}, 1., false, true},
                                   {"slip, held", {slip}, 1., false, true},
                                   {"mixed, held", mixed, 2., false, true},
                                   {"open, in the mean", {open}, 1., true},
                                   {"frictionless, in the mean", {frictionless}, 1., true},
                                   {"stick, in the mean", {stick}, 1., true},
                                   {"slip, in the mean", {slip}, 1., true},
                                   {"slip, in the mean, inside of the ball", {slip}, 0.3, true},
                                   {"slip, in the mean, orthotropic", {slip}, 1., true, false, orthotropic},
                                   {"slip, in the mean, held", {slip}, 1., true, true}};
  std::vector<Case> all(std::begin(cases), std::end(cases));
  // those of laws that are not regularised, on surfaces that give way
  for (const Case &what : cases)
    if (!what.in_the_mean && !what.held)
    {
      all.push_back(what);
      all.back().name += ", gives way";
      all.back().compliant = true;
    }
  // nodal and averaged scheme with one point a node, consistent weights, integration points; linear and quadratic faces
  const Kind kinds[] = {{"one node", 1, 1},
                        {"four nodes", 4, 4},
                        {"nine nodes", 9, 9},
                        {"four nodes, one jump", 4, 1},
                        {"nine nodes, one jump", 9, 1}};
  for (const Kind &kind : kinds)
    for (const Case &what : all)
    {
      // only integration points have regularised laws; one jump, one status
      if (what.in_the_mean ? kind.n_jumps == kind.n_nodes : kind.n_jumps == 1 && what.status.size() > 1)
        continue;
      compare(kind, what);
    }
  known_values();
}
