// Rows of the jump operator where a slave node passes over an edge between two faces of a curved master, on smoothed
// surfaces and with friction: the weights that balance moments do not jump there (eq. J4, J5 with the shares J6), nor
// does the normal, of facets either (eq. P5). Averages of a fixed rule whose points go over the rim of the master,
// which do not jump either (eq. J7). A part of the master that bends down along an edge, until that is sharp and the
// part too steep for averages over segments: neither normals and offsets of smoothed surfaces (eq. P1) nor averages
// (eq. J8) jump. A slave face that is all opposite a steep face keeps the dual functions. Averages over segments whose
// slave node lies over a master node, where they have no other master node: moments balance there, too (eq. J6).

#include "../contact_fixture.h"

#include <cmath>
#include <map>
#include <memory>

using namespace Cases;

namespace
{
  using Pair = ContactPairParameters;

  /// Weights, turns times the lever and lever of a site, by node.
  std::map<unsigned int, std::array<double, 4>> row(ContactFixture &fixture, const unsigned int site)
  {
    std::map<unsigned int, std::array<double, 4>> result;
    for (auto e = fixture.jump.begin(site); e != fixture.jump.end(site); ++e)
    {
      const Vector3 turn = fixture.jump.lever(site) * e->turn;
      result[e->node]    = {{e->weight, turn[0], turn[1], turn[2]}};
    }
    return result;
  }

  void pass(const std::string &name, const unsigned int degree, const bool hanging, const Pair::Normal normal)
  {
    std::vector<BodyParameters> bodies{box("lower", "4,4,1", {-1, -1, -1}, {1, 1, 0}, 1, 0),
                                       box("upper", "1,1,1", {-0.5, -0.5, 0}, {0.5, 0.5, 1}, 1, 0)};
    if (hanging)
    {
      bodies[0].refine_where     = "x<0";
      bodies[0].local_refinement = 1;
    }
    Pair p                 = pair(region(2, {z_minus}), region(1, {z_plus}));
    p.scheme               = Pair::Scheme::nodal;
    p.surface              = Pair::Surface::smoothed;
    p.normal               = normal;
    p.friction_coefficient = 0.3;
    ContactFixture    fixture(bodies, {p}, degree);
    auto             &x = fixture.state.x;
    std::vector<bool> is_slave(x.size(), false);
    for (const SlaveNode &k : fixture.surfaces->slave_nodes())
      is_slave[k.node] = true;
    for (unsigned int i = 0; i < x.size(); ++i)
      if (!is_slave[i])
        x[i][2] -= 0.15 * x[i][0] * x[i][0] + 0.1 * x[i][1] * x[i][1] + 0.04 * x[i][0] * x[i][1];
    for (unsigned int i = 0; i < x.size(); ++i) // hanging nodes go where those are that they follow
      if (const SurfaceNode &node = fixture.surfaces->nodes()[i]; !node.masters.empty())
      {
        Vector3 at = node.offset;
        for (const auto &[master, weight] : node.masters)
          at += weight * x[master];
        x[i] = Point(at);
      }
    const auto start = x;
    const auto go_to = [&](const double s) // the first node across the edge x = -0.5
    {
      for (unsigned int i = 0; i < x.size(); ++i)
        if (is_slave[i])
          x[i] = start[i] + Vector3({0.2 * s - 0.1, 0.13, -0.05});
      fixture.pair_at(x);
      return fixture.pairing[0].master.face;
    };
    const unsigned int first = go_to(0.), last = go_to(1.);
    report(name + ": the node goes from one face to another", first == last ? "NO" : "yes");
    double low = 0., high = 1.;
    while (high - low > 1e-9)
    {
      const double middle                   = 0.5 * (low + high);
      (go_to(middle) == first ? low : high) = middle;
    }
    go_to(low);
    const auto    before        = row(fixture, 0);
    const Vector3 normal_before = fixture.pairing[0].normal;
    go_to(high);
    auto   after   = row(fixture, 0);
    double largest = 0., change = 0.;
    for (const auto &[node, values] : before)
      after.emplace(node, std::array<double, 4>{{0., 0., 0., 0.}});
    for (const auto &[node, values] : after)
    {
      const auto at = before.find(node);
      for (unsigned int i = 0; i < 4; ++i)
      {
        change  = std::max(change, std::abs(values[i] - (at == before.end() ? 0. : at->second[i])));
        largest = std::max(largest, std::abs(values[i]));
      }
    }
    report(name + ": change across an edge, of a largest entry of " + Numbers::number(largest, 3),
           Numbers::error_below(change, 1e-4, 2));
    report(name + ": change of the normal",
           Numbers::error_below((fixture.pairing[0].normal - normal_before).norm(), 1e-4, 2));
  }

  /// A face that moves over the rim of the master by steps of 1e-4 faces, until a node has no row any more (eq. J9).
  /// Points fade out over 0.025 faces, so that a row may change by some 40 times as much; a column of points that goes
  /// at once would change it by a tenth.
  void leave(const std::string &name, const unsigned int degree)
  {
    const std::vector<BodyParameters> bodies{box("lower", "2,2,1", {-1, -1, -1}, {1, 1, 0}, 1, 0),
                                             box("upper", "1,1,1", {-0.5, -0.5, 0}, {0.5, 0.5, 1}, 1, 0)};
    Pair                              p = pair(region(2, {z_minus}), region(1, {z_plus}));
    p.scheme                            = Pair::Scheme::averaged;
    p.integration                       = Pair::Integration::face;
    ContactFixture    fixture(bodies, {p}, degree);
    auto             &x     = fixture.state.x;
    const auto        start = x;
    std::vector<bool> is_slave(x.size(), false);
    for (const SlaveNode &k : fixture.surfaces->slave_nodes())
      is_slave[k.node] = true;
    double                                        change = 0., least = 1.;
    const double                                  whole = fixture.averaged.row(0).whole;
    std::map<unsigned int, std::array<double, 4>> before;
    for (unsigned int step = 0; step <= 4000; ++step)
    {
      for (unsigned int i = 0; i < x.size(); ++i)
        if (is_slave[i])
          x[i] = start[i] + Vector3({-0.45 - 1e-4 * step, 0., 0.01});
      fixture.pair_at(x);
      if (!fixture.averaged.covered(0))
        break;
      auto after = row(fixture, 0);
      after[-1u] = {{fixture.averaged.row(0).area / whole, 0., 0., 0.}};
      least      = std::min(least, after[-1u][0]);
      for (const auto &[node, values] : after)
        if (step > 0)
          change = std::max(change, std::abs(values[0] - (before.count(node) > 0 ? before[node][0] : 0.)));
      before = std::move(after);
    }
    report(name + ": least covered part around the first node", Numbers::number(least, 2));
    report(name + ": largest change of weights and covered part in a step", Numbers::error_below(change, 5e-3, 2));
  }

  /// The master that is bent by an angle along its middle, x = 0, and the slave above that.
  class BentMaster
  {
  public:
    BentMaster(const Pair::Scheme scheme, const Pair::Surface surface, const double begin, const double end)
        : pair_(pair(region(2, {z_minus}), region(1, {z_plus})))
    {
      pair_.scheme  = scheme;
      pair_.surface = surface;
      fixture_      = std::make_unique<ContactFixture>(
          std::vector<BodyParameters>{box("lower", "4,1,1", {-1, -0.5, -1}, {1, 0.5, 0}, 1, 0),
                                           box("upper", "1,1,1", {begin, -0.3, 0.02}, {end, 0.3, 1}, 1, 0)},
          std::vector<Pair>{pair_},
          1);
      start_ = fixture_->state.x;
    }
    ContactFixture &at(const double degrees)
    {
      const double angle = degrees * dealii::numbers::PI / 180.;
      auto        &x     = fixture_->state.x;
      for (unsigned int i = 0; i < x.size(); ++i)
        if (start_[i][2] < 0.01 && start_[i][0] < 0.)
          x[i] = Point(std::cos(angle) * start_[i][0], start_[i][1], std::sin(angle) * start_[i][0]);
      fixture_->pair_at(x);
      return *fixture_;
    }

  private:
    Pair                            pair_;
    std::unique_ptr<ContactFixture> fixture_;
    std::vector<Point>              start_;
  };

  /// From 30 to 88 degrees in steps of 0.01. Between 45 and 75 degrees, where faces fade out, a weight may go from 1
  /// to 0: by some 1e-3 a step.
  /// Averages do not see the bent part from 75 degrees on.
  void bend(const std::string &name, const Pair::Scheme scheme, const Pair::Surface surface, const double until)
  {
    BentMaster                                    master(scheme, surface, -0.1, 0.5);
    std::map<unsigned int, std::array<double, 4>> before;
    double                                        change = 0.;
    for (unsigned int step = 0; 30. + 0.01 * step <= until; ++step)
    {
      ContactFixture &fixture = master.at(30. + 0.01 * step);
      auto            after   = row(fixture, 0);
      const Vector3   gap = fixture.jump.jump(0, fixture.state.x), normal = fixture.pairing[0].normal;
      after[-1u] = {{fixture.weights.area()[0], gap[0], gap[1], gap[2]}};
      after[-2u] = {{0., normal[0], normal[1], normal[2]}};
      for (const auto &[node, values] : after)
        for (unsigned int i = 0; i < 4 && step > 0; ++i)
          change = std::max(change, std::abs(values[i] - (before.count(node) > 0 ? before[node][i] : 0.)));
      before = std::move(after);
    }
    report(name + ": largest change of weights, gap, normal and area in a step", Numbers::error_below(change, 5e-3, 2));
  }

  /// The mean distance of a face that is all opposite the bent part is that of the node, however little it counts:
  /// dual functions give the value of a linear function at the node.
  void opposite()
  {
    double error = 0.;
    for (const double degrees : {30., 50., 60., 70.})
    {
      BentMaster      master(Pair::Scheme::averaged, Pair::Surface::faceted, -0.15, -0.02);
      ContactFixture &fixture  = master.at(degrees);
      const double    angle    = degrees * dealii::numbers::PI / 180.;
      const Point     x        = fixture.state.x[fixture.surfaces->slave_nodes()[0].node];
      const double    distance = std::cos(angle) * x[2] - std::sin(angle) * x[0];
      error =
          std::max(error, std::abs(-fixture.pairing[0].normal * fixture.jump.jump(0, fixture.state.x) / distance - 1.));
    }
    report("a face all opposite a bent part of 30 to 70 degrees: distance of a node against that of its position",
           Numbers::error_below(error, 1e-6, 2));
  }

  /// A fine slave above a curved master, both with a node at (0.5, 0.5).
  void over_a_node()
  {
    Pair p                 = pair(region(2, {z_minus}), region(1, {z_plus}));
    p.scheme               = Pair::Scheme::averaged;
    p.surface              = Pair::Surface::smoothed;
    p.normal               = Pair::Normal::averaged;
    p.friction_coefficient = 0.3;
    ContactFixture fixture({box("lower", "4,4,1", {-1, -1, -1}, {1, 1, 0}, 1, 0),
                            box("upper", "6,6,1", {0.1, 0.1, 0}, {0.9, 0.9, 1}, 1, 0)},
                           {p},
                           1);
    auto          &x = fixture.state.x;
    for (auto &point : x) // nearly flat: with more curvature the other master nodes weigh enough
      if (point[2] > -0.5)
        point[2] -= 1.5e-3 * point[0] * point[0] + 1e-3 * point[1] * point[1] + 4e-4 * point[0] * point[1];
    fixture.pair_at(x);
    unsigned int fewest = -1u;
    double       beside = 0.;
    for (unsigned int k = 0; k < fixture.surfaces->slave_nodes().size(); ++k)
    {
      Vector3      apart;
      unsigned int heavy = 0;
      for (auto e = fixture.jump.begin(k); e != fixture.jump.end(k); ++e)
      {
        apart += e->weight * x[e->node];
        heavy += e >= fixture.jump.middle(k) && std::abs(e->unbalanced) > 1e-3;
      }
      const Vector3 &n = fixture.jump.normal(k);
      fewest           = std::min(fewest, heavy);
      beside           = std::max(beside, (apart - (apart * n) * n).norm() / fixture.jump.size(k));
    }
    check_equal("over a node: fewest master nodes of an average", fewest, 1);
    report("over a node: how far the master point is beside the normal", Numbers::error_below(beside, 1e-12, 2));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Normal = Pair::Normal;
  pass("degree 1", 1, false, Normal::averaged);
  pass("degree 1, hanging nodes", 1, true, Normal::averaged);
  pass("degree 2", 2, false, Normal::averaged);
  pass("degree 1, normals of facets", 1, false, Normal::master_facet);
  pass("degree 1, hanging nodes, normals of facets", 1, true, Normal::master_facet);
  pass("degree 2, normals of facets", 2, false, Normal::master_facet);
  leave("degree 1, points that leave the master", 1);
  leave("degree 2, points that leave the master", 2);
  bend("nodal, smoothed, an edge that becomes sharp", Pair::Scheme::nodal, Pair::Surface::smoothed, 88.);
  bend("averaged, facets, a face that becomes steep", Pair::Scheme::averaged, Pair::Surface::faceted, 74.99);
  bend("averaged, smoothed, both", Pair::Scheme::averaged, Pair::Surface::smoothed, 74.99);
  opposite();
  over_a_node();
}
