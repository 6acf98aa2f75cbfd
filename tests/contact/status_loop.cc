// One slave node through the status loop: what contradicts a status, what follows, what the ledger says. A node that
// opened in this loop and closes again slips: with stick on closing, stick that pulls the node open would cycle; so
// does one that closes farther away than friction can hold: with friction mu and augmentation factor a, beyond mu d /
// a. One that cycles keeps the status that it has then (open, which it contradicts by 7 * 0.01 of the largest
// pressure), and an integration point that cycles has the regularised law: friction contradicts its status no more.

#include "../contact_fixture.h"

using namespace Cases;

namespace
{
  const char *name(const ContactStatus status)
  {
    return status == ContactStatus::open ? "open" : status == ContactStatus::slip ? "slip" : "stick";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  ContactFixture                           fixture(
      {box("lower", "1,1,1", {0, 0, 0}, {1, 1, 1}, 1, 0), box("upper", "1,1,1", {0, 0, 1}, {1, 1, 2}, 1, 0)},
      {pair(region(2, {z_minus}), region(1, {z_plus}), 0.5)},
      1);
  Status            &status = *fixture.status;
  const unsigned int n      = status.size();

  const auto step = [&](const std::string &what,
                        const double       pressure,
                        const double       distance,
                        const double       Lambda,
                        const double       slip = 0.)
  {
    StatusInput input;
    input.pressure.assign(n, -1.);
    input.distance.assign(n, 0.);
    input.Lambda.assign(n, {{0., 0.}});
    input.slip.assign(n, {{0., 0.}});
    input.pressure[0]          = pressure;
    input.distance[0]          = distance;
    input.Lambda[0][0]         = Lambda;
    input.slip[0][1]           = slip;
    const auto          update = status.update(input);
    const StatusLedger &ledger = status.ledger(0);
    std::cout << what << ": " << name(status.status(0)) << ", changes " << ledger.changes << ", last contradiction "
              << static_cast<int>(ledger.last) << ", period " << update.period << (update.cycles ? ", cycles" : "")
              << std::endl;
  };
  for (unsigned int k = 0; k < n; ++k)
    status.assign(k, true, true, -1.);
  status.begin_increment();

  status.begin_loop();
  step("stick within the cone", -1., 0., 0.9);
  step("stick beyond the cone", -1., 0., 1.1);
  step("slip against the traction", -1., 0., 0.5);
  status.begin_loop();
  step("closed under tension", 1., 0., 0.);
  step("open and apart", 0., -0.1, 0.);
  step("open and penetrating, opened in this loop", 0., 0.1, 0.);
  step("under tension again", 1., 0., 0.);
  status.begin_loop();
  step("open and penetrating, open since before", 0., 0.1, 0.);
  const double reach = 0.5 * 0.1 / ContactPairParameters().tangential_augmentation_factor;
  for (const double slip : {0.99 * reach, -1.01 * reach})
  {
    status.assign(0, false, true, -1.);
    status.begin_loop();
    step(slip > 0. ? "closing within the reach of friction" : "closing beyond it", 0., 0.1, 0., slip);
    status.assign(0, true, true, -1.);
  }
  std::cout << "cycle period in the ledger: " << status.ledger(0).period << ", of another node "
            << status.ledger(1).period << std::endl;
  status.begin_increment();
  std::cout << "next increment: changes " << status.ledger(0).changes << std::endl;

  StatusInput tension, penetration;
  for (StatusInput *input : {&tension, &penetration})
  {
    input->pressure.assign(n, -1.);
    input->distance.assign(n, 0.);
    input->Lambda.assign(n, {{0., 0.}});
    input->slip.assign(n, {{0., 0.}});
  }
  tension.pressure[0]     = 0.3;
  penetration.pressure[0] = 0.;
  penetration.distance[0] = 0.01;
  status.begin_loop();
  unsigned int passes = 0, frozen = 0;
  for (; passes < 10 && frozen == 0; ++passes)
    frozen = status.update(status.contact(0) ? tension : penetration).frozen;
  const Status::Violation violation = status.frozen_violation(penetration);
  std::cout << "frozen after " << passes << " passes: " << frozen << " site, " << name(status.status(0))
            << ", violation " << violation.value << " at " << violation.sites << " site" << std::endl;
  std::cout << "changes once frozen: " << status.update(penetration).changes << std::endl;

  auto points   = pair(region(2, {z_minus}), region(1, {z_plus}), 0.5);
  points.scheme = ContactPairParameters::Scheme::integration_point;
  ContactFixture at_points(
      {box("lower", "1,1,1", {0, 0, 0}, {1, 1, 1}, 1, 0), box("upper", "1,1,1", {0, 0, 1}, {1, 1, 2}, 1, 0)},
      {points},
      1);
  Status            &mean  = *at_points.status;
  const unsigned int first = at_points.surfaces->slave_nodes().size();
  for (StatusInput *input : {&tension, &penetration})
  {
    input->pressure.resize(mean.size(), -1.);
    input->distance.resize(mean.size(), 0.);
    input->Lambda.resize(mean.size(), {{0., 0.}});
    input->slip.resize(mean.size(), {{0., 0.}});
    for (unsigned int k = 0; k < first; ++k)
      input->pressure[k] = input->distance[k] = 0.;
  }
  tension.pressure[first]     = 0.3;
  penetration.pressure[first] = 0.;
  penetration.distance[first] = 0.01;
  for (unsigned int s = first; s < mean.size(); ++s)
    mean.assign(s, true, true, -1.);
  mean.begin_increment();
  mean.begin_loop();
  bool to_regularised = false;
  for (passes = 0; passes < 10 && !to_regularised; ++passes)
    to_regularised = mean.update(mean.contact(first) ? tension : penetration).to_regularised;
  std::cout << "laws regularised after " << passes << " passes: " << mean.projected(first) << std::endl;
  tension.pressure[first]  = 0.;
  tension.Lambda[first][0] = 0.;
  for (unsigned int s = first; s < mean.size(); ++s)
    tension.Lambda[s][0] = 1.5;
  std::cout << "changes beyond the cone: " << mean.update(tension).changes
            << ", reported: " << name(mean.status(first + 1)) << std::endl;
  mean.begin_increment();
  std::cout << "next increment: " << mean.projected(first) << std::endl;
}
