// The block matrix and right-hand side of the paper's equations (60)-(61): slave node 1 sticks, 2 slips, 3 is open,
// each facing one master node. All 12 x 12 blocks of the assembled matrix, unknowns (u slave 1-3, u master 1-3, lambda
// 1-3, Lambda 1-3), are compared with the blocks written down by hand from the weak form.

#include "../contact_fixture.h"

#include <array>

using namespace Cases;
using dealii::FullMatrix;

namespace
{
  FullMatrix<double>
  block(const FullMatrix<double> &K, const std::vector<DoFIndex> &rows, const std::vector<DoFIndex> &columns)
  {
    FullMatrix<double> b(rows.size(), columns.size());
    for (unsigned int i = 0; i < rows.size(); ++i)
      for (unsigned int j = 0; j < columns.size(); ++j)
        b(i, j) = K(rows[i], columns[j]);
    return b;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  auto contact_pair                           = pair(region(2, {z_minus}), region(1, {z_plus}), 0.5);
  contact_pair.tangential_augmentation_factor = 1.;
  ContactFixture fixture(
      {box("lower", "1,1,1", {0, 0, 0}, {1, 1, 1}, 1, 0), box("upper", "1,1,1", {0, 0, 1}, {1, 1, 2}, 1, 0)},
      {contact_pair},
      1);
  const auto &surfaces = *fixture.surfaces;
  auto       &state    = fixture.state;

  // Slave nodes 1 stick, 2 slip, 3 open, the fourth open as well; every threshold, multiplier and motion different.
  const double thresholds[] = {-2., -3., -4., -5.};
  for (unsigned int k = 0; k < 4; ++k)
  {
    fixture.status->assign(k, k < 2, k == 0, thresholds[k]);
    state.lambda[k] = -1. - k;
    state.Lambda[k] = {{0.3 + 0.5 * k, -0.6 * k}}; // the slip node's w is longer than 1
    const Vector3 move({0.02 * (k + 1), -0.01 * k, -0.005 * (k + 1)});
    const auto    i = surfaces.slave_nodes()[k].node;
    state.increment[i] += move;
    state.x[i] += move;
  }
  const ContactResidual    residual = fixture.assemble();
  const FullMatrix<double> K        = fixture.matrix();
  const auto              &layout   = surfaces.layout();

  // The 12 blocks of unknowns.
  std::vector<std::vector<DoFIndex>> unknowns;
  for (unsigned int k = 0; k < 3; ++k)
  {
    const auto &dofs = surfaces.nodes()[surfaces.slave_nodes()[k].node].dofs;
    unknowns.emplace_back(dofs.begin(), dofs.end());
  }
  for (unsigned int k = 0; k < 3; ++k)
    for (const auto &node : surfaces.nodes())
      if (surfaces.slave_number(0, &node - surfaces.nodes().data()) == dealii::numbers::invalid_unsigned_int &&
          node.X.distance(surfaces.nodes()[surfaces.slave_nodes()[k].node].X) < 1e-12)
        unknowns.emplace_back(node.dofs.begin(), node.dofs.end());
  for (unsigned int k = 0; k < 3; ++k)
    unknowns.push_back({layout.lambda(k)});
  for (unsigned int k = 0; k < 3; ++k)
    unknowns.push_back({layout.Lambda(k, 0), layout.Lambda(k, 1)});

  // By hand: area 1/4 a node, normal -z, tangents x and -y (right-handed with the normal).
  const double       m = 0.25, h_n = ContactFixture::normal_augmentation;
  FullMatrix<double> n(3, 1), T(2, 3), Tt(3, 2);
  n(2, 0) = -1.;
  T(0, 0) = 1.;
  T(1, 1) = -1.;
  Tt.copy_transposed(T);
  const double tau1 = thresholds[0], tau2 = thresholds[1], h2 = h_n / 3.;
  const double w[2]   = {state.Lambda[1][0] + h2 * 0.04, state.Lambda[1][1] + h2 * 0.01};
  const double length = std::hypot(w[0], w[1]);
  const double pi[2]  = {w[0] / length, w[1] / length};

  FullMatrix<double> K_B(2, 2), I_minus_K_B(2, 2), K_B_T(2, 3), Tt_K_B_T(3, 3);
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int j = 0; j < 2; ++j)
    {
      K_B(i, j)         = ((i == j ? 1. : 0.) - pi[i] * pi[j]) / length;
      I_minus_K_B(i, j) = (i == j ? 1. : 0.) - K_B(i, j);
    }
  K_B.mmult(K_B_T, T);
  Tt.mmult(Tt_K_B_T, K_B_T);

  std::array<std::array<FullMatrix<double>, 12>, 12> expected;
  for (unsigned int i = 0; i < 12; ++i)
    for (unsigned int j = 0; j < 12; ++j)
      expected[i][j].reinit(unknowns[i].size(), unknowns[j].size());
  const auto set = [&](const unsigned int i, const unsigned int j, const double factor, const FullMatrix<double> &b)
  {
    expected[i][j].equ(factor, b);
    if (i != j)
      expected[j][i].copy_transposed(expected[i][j]);
  };
  const FullMatrix<double> one(dealii::IdentityMatrix(1)), two(dealii::IdentityMatrix(2));
  for (unsigned int k = 0; k < 2; ++k)
  {
    set(k, 6 + k, -m, n);
    set(3 + k, 6 + k, m, n);
  }
  set(0, 9, -m * tau1, Tt);
  set(3, 9, m * tau1, Tt);
  set(1, 1, -m * tau2 * h2, Tt_K_B_T);
  set(4, 4, -m * tau2 * h2, Tt_K_B_T);
  set(1, 4, m * tau2 * h2, Tt_K_B_T);
  FullMatrix<double> Tt_K_B(3, 2);
  Tt_K_B.copy_transposed(K_B_T);
  set(1, 10, -m * tau2, Tt_K_B);
  set(4, 10, m * tau2, Tt_K_B);
  set(10, 10, m * tau2 / h2, I_minus_K_B);
  set(8, 8, -m / h_n, one);
  set(11, 11, -m, two);

  const char *names[] = {
      "u1", "u2", "u3", "u'1", "u'2", "u'3", "lambda1", "lambda2", "lambda3", "Lambda1", "Lambda2", "Lambda3"};
  unsigned int wrong = 0, nonzero = 0;
  for (unsigned int i = 0; i < 12; ++i)
    for (unsigned int j = 0; j < 12; ++j)
    {
      FullMatrix<double> difference = block(K, unknowns[i], unknowns[j]);
      difference.add(-1., expected[i][j]);
      nonzero += expected[i][j].frobenius_norm() > 0.;
      if (difference.frobenius_norm() > 1e-13)
      {
        ++wrong;
        std::cout << "block (" << names[i] << ", " << names[j] << ") is wrong by " << difference.frobenius_norm()
                  << std::endl;
      }
    }
  std::cout << "blocks: 144 compared, " << nonzero << " not zero, " << wrong << " wrong" << std::endl;

  // Right-hand side -R of the same rows.
  double error = 0.;
  for (unsigned int k = 0; k < 3; ++k)
  {
    const double distance = 0.005 * (k + 1); // moved down by that much
    const double lambda   = state.lambda[k];
    Vector3      force; // R conjugate to the slave node's jump
    double       law = 0.;
    double       friction_law[2];
    if (k < 2)
    {
      force[2] = m * lambda;
      law      = -m * distance;
    }
    else
      law = -m / h_n * lambda;
    const double slip[2] = {0.02 * (k + 1), 0.01 * k};
    for (unsigned int i = 0; i < 2; ++i)
    {
      const double Lambda = state.Lambda[k][i], sign = i == 0 ? 1. : -1.;
      if (k == 0)
      {
        force[i] += -m * tau1 * Lambda * sign;
        friction_law[i] = -m * tau1 * slip[i];
      }
      else if (k == 1)
      {
        force[i] += -m * tau2 * pi[i] * sign;
        friction_law[i] = m * tau2 / h2 * (Lambda - pi[i]);
      }
      else
        friction_law[i] = -m * Lambda;
      error = std::max(error, std::abs(friction_law[i] + fixture.system.rhs.block(2)(2 * k + i)));
    }
    error = std::max(error, std::abs(law + fixture.system.rhs.block(1)(k)));
    for (unsigned int c = 0; c < 3; ++c)
    {
      error = std::max(error, std::abs(force[c] + fixture.system.rhs.block(0)(unknowns[k][c])));
      error = std::max(error, std::abs(-force[c] + fixture.system.rhs.block(0)(unknowns[3 + k][c])));
    }
    error = std::max(error, (residual.jump[k] - force).norm());
  }
  check("right-hand side to 1e-13", error < 1e-13);

  double asymmetry = 0.;
  for (unsigned int i = 0; i < K.m(); ++i)
    for (unsigned int j = 0; j < i; ++j)
      asymmetry = std::max(asymmetry, std::abs(K(i, j) - K(j, i)));
  check("symmetric to 1e-13", asymmetry < 1e-13);
}
