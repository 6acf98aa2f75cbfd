// The contact tangent against central differences of the contact residual, 1e-6 relative, for every scheme and
// weighting, Q1 and Q2 faces, faceted and smoothed, and all status combinations on non-matching, curved and rotated
// surfaces; symmetry to 1e-12. The same of integration points whose laws are regularised, with thresholds that are
// frozen and with those that follow the pressure (eq. T1 to T5).

#include "../contact_fixture.h"
#include "contact/site_values.h"

#include <random>

using namespace Cases;

namespace
{
  /// Thresholds that follow the pressures.
  void follow_pressure(ContactFixture &f)
  {
    f.status->freeze_threshold(friction_pressure(*f.surfaces, f.pairing, f.weights, *f.status, *f.assembler, f.state));
  }

  /// Residual in flat indices.
  std::vector<double> flat_residual(ContactFixture &fixture, const bool follows)
  {
    if (follows)
      follow_pressure(fixture);
    const ContactResidual r      = fixture.assemble();
    const auto           &layout = fixture.surfaces->layout();
    std::vector<double>   R(layout.size(), 0.);
    for (unsigned int s = 0; s < fixture.surfaces->n_sites(); ++s)
      for (auto e = fixture.jump.begin(s); e != fixture.jump.end(s); ++e)
        for (unsigned int c = 0; c < 3; ++c)
          R[fixture.surfaces->nodes()[e->node].dofs[c]] += fixture.jump.force(s, *e, r.jump[s])[c];
    for (unsigned int k = 0; k < layout.n_slave_nodes; ++k)
    {
      R[layout.lambda(k)] = r.lambda[k];
      for (unsigned int i = 0; i < 2; ++i)
        R[layout.Lambda(k, i)] = r.Lambda[k][i];
    }
    return R;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using Weights = ContactPairParameters::Weights;
  using Scheme  = ContactPairParameters::Scheme;
  struct Kind
  {
    std::string                        name;
    Scheme                             scheme;
    Weights                            weights;
    ContactPairParameters::Integration integration;
    ContactPairParameters::Surface     surface;
    bool                               gives_way = false; ///< a pressure-gap law and elastic slip
    bool                               follows   = false; ///< thresholds the pressure
  };
  const auto face = ContactPairParameters::Integration::face, segment = ContactPairParameters::Integration::segment;
  const auto faceted = ContactPairParameters::Surface::faceted, smoothed = ContactPairParameters::Surface::smoothed;
  const Kind kinds[] = {
      {"nodal quadrature", Scheme::nodal, Weights::nodal_quadrature, face, faceted},
      {"dual", Scheme::nodal, Weights::dual, face, smoothed},
      {"consistent", Scheme::nodal, Weights::consistent, face, faceted},
      {"averaged, face", Scheme::averaged, Weights::dual, face, faceted},
      {"averaged, segment", Scheme::averaged, Weights::dual, segment, smoothed},
      {"integration point", Scheme::integration_point, Weights::dual, face, smoothed},
      {"integration point, regularised", Scheme::integration_point, Weights::dual, face, smoothed},
      {"integration point, regularised, coupled",
       Scheme::integration_point,
       Weights::dual,
       face,
       smoothed,
       false,
       true},
      {"nodal quadrature, gives way", Scheme::nodal, Weights::nodal_quadrature, face, faceted, true},
      {"consistent, gives way", Scheme::nodal, Weights::consistent, face, faceted, true},
      {"averaged, gives way", Scheme::averaged, Weights::dual, segment, smoothed, true},
      {"integration point, gives way", Scheme::integration_point, Weights::dual, face, smoothed, true}};

  for (const unsigned int degree : {1u, 2u})
    for (const auto &[name, scheme, weighting, integration, surface, gives_way, follows] : kinds)
    {
      auto bodies = std::vector<BodyParameters>{box("lower", "2,2,1", {0, 0, 0}, {1, 1, 1}, 1, 0),
                                                box("upper", "1,3,1", {0.1, 0.1, 1.02}, {0.9, 0.9, 2}, 1, 0)};
      for (auto &b : bodies)
      {
        b.rotation_axis  = Vector3({1, 2, 0.5});
        b.rotation_angle = 33;
      }
      auto p        = pair(region(2, {z_minus}), region(1, {z_plus}), 0.4);
      p.weights     = weighting;
      p.scheme      = scheme;
      p.integration = integration;
      p.surface     = surface;
      if (gives_way)
      {
        p.elastic_slip                   = 0.1;
        p.pressure_gap.law               = PressureGapParameters::Law::exponential;
        p.pressure_gap.stiffness         = 20.;
        p.pressure_gap.stiffening_length = 0.03;
      }
      ContactFixture fixture(bodies, {p}, degree);
      auto          &state = fixture.state;

      // Random positions, multipliers and thresholds; statuses in turn, so that faces mix all of them.
      std::mt19937                           generator(1);
      std::uniform_real_distribution<double> random(-1., 1.);
      for (unsigned int i = 0; i < state.x.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
        {
          const double move = 0.02 * random(generator);
          state.x[i][c] += move;
          state.increment[i][c] += move;
        }
      fixture.pair_at(state.x);
      unsigned int unpaired = 0;
      for (unsigned int s = 0; s < fixture.surfaces->n_sites(); ++s)
      {
        const bool paired = fixture.pairing[s].found && fixture.surfaces->has_status(s);
        unpaired += fixture.surfaces->has_status(s) && !paired;
        fixture.status->assign(s, paired && s % 3 != 2, s % 3 == 0, -1. - 0.5 * random(generator));
      }
      for (unsigned int k = 0; k < state.lambda.size(); ++k)
      {
        state.lambda[k] = -1. + 0.5 * random(generator);
        state.Lambda[k] = {{random(generator), random(generator)}};
      }

      if (gives_way)
        for (Vector3 &slip : state.elastic_slip)
          slip = 0.05 * Vector3({random(generator), random(generator), random(generator)});

      if (name.find("regularised") != std::string::npos)
        fixture.status->regularise();
      if (follows)
        follow_pressure(fixture);
      fixture.assemble(follows);
      const auto   K         = fixture.matrix();
      const double K_largest = K.linfty_norm();
      double       asymmetry = 0.;
      for (unsigned int i = 0; i < K.m(); ++i)
        for (unsigned int j = 0; j < i; ++j)
          asymmetry = std::max(asymmetry, std::abs(K(i, j) - K(j, i)));

      // All displacement and multiplier unknowns of the surfaces.
      std::vector<std::pair<DoFIndex, std::vector<double *>>> unknowns;
      for (unsigned int i = 0; i < state.x.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          unknowns.push_back({fixture.surfaces->nodes()[i].dofs[c], {&state.x[i][c], &state.increment[i][c]}});
      for (unsigned int k = 0; k < state.lambda.size(); ++k)
      {
        unknowns.push_back({fixture.surfaces->layout().lambda(k), {&state.lambda[k]}});
        for (unsigned int i = 0; i < 2; ++i)
          unknowns.push_back({fixture.surfaces->layout().Lambda(k, i), {&state.Lambda[k][i]}});
      }
      // Per column, relative to the column's largest entry, so that no block hides behind a larger one.
      double       worst = 0.;
      const double step  = 1e-6;
      for (const auto &[column, values] : unknowns)
      {
        std::vector<double> difference(K.m(), 0.);
        for (const double sign : {1., -1.})
        {
          for (double *v : values)
            *v += sign * step;
          const auto R = flat_residual(fixture, follows);
          for (unsigned int i = 0; i < K.m(); ++i)
            difference[i] += sign * R[i] / (2 * step);
          for (double *v : values)
            *v -= sign * step;
        }
        double largest = 1e-3 * K_largest / K.m(), error = 0.;
        for (unsigned int i = 0; i < K.m(); ++i)
        {
          largest = std::max(largest, std::abs(K(i, column)));
          error   = std::max(error, std::abs(K(i, column) - difference[i]));
        }
        worst = std::max(worst, error / largest);
      }
      if (std::getenv("NODUS_TEST_LOG") != nullptr)
        std::cout << "   worst " << worst << " asymmetry " << asymmetry / K_largest << std::endl;
      std::cout << "Q" << degree << ", " << name << ", " << unpaired << " unpaired:" << std::endl;
      report("  largest row sum of the tangent", Numbers::number(K_largest));
      check("  tangent to 1e-6", worst < 1e-6);
      if (!follows)
        check("  symmetric to 1e-12", asymmetry < 1e-12 * K_largest);
    }
}
