// Every member of a State is filled with random numbers and sent through roll-back, the way back of the friction
// continuation, a checkpoint, and the transfer to another mesh (here: to the same one, with what it leaves out on
// purpose: areas, reactions to be released, and which sites stick). Printed are how many numbers a state has on all
// ranks, and after each way the largest difference that is left and how many are the same. The members are listed here
// once more, so that one which visit_members() does not visit is found; one that is not filled here does not compile.

#include "../restart/sliding_block.h"

#include "run/checkpointing.h"
#include "run/state_vectors.h"

#include <deal.II/base/mpi.h>

#include <random>

using namespace SlidingBlock;

namespace
{
  /// Calls f for every number of a state; chars count as 0 or 1.
  template <typename Function>
  struct EachNumber
  {
    const Model &model;
    Function     f;

    void operator()(char &value)
    {
      double number = value;
      f(number);
      value = number > 0.5;
    }
    void operator()(bool &value)
    {
      double number = value;
      f(number);
      value = number > 0.5;
    }
    void operator()(double &value)
    {
      f(value);
    }
    void operator()(Vector3 &value)
    {
      for (unsigned int c = 0; c < dim; ++c)
        f(value[c]);
    }
    void operator()(dealii::Tensor<2, dim> &value)
    {
      for (unsigned int c = 0; c < dim; ++c)
        (*this)(value[c]);
    }
    template <typename T, std::size_t n>
    void operator()(std::array<T, n> &values)
    {
      for (T &value : values)
        (*this)(value);
    }
    template <typename T>
    void operator()(std::vector<T> &values)
    {
      for (T &value : values)
        (*this)(value);
    }
    void operator()(RigidBodies::State &body)
    {
      auto &[translation, turn, rotation, prescribed_rotation, applied, motion] = body;
      (*this)(translation);
      (*this)(turn);
      (*this)(rotation);
      (*this)(prescribed_rotation);
      (*this)(applied);
      (*this)(motion);
    }
    void operator()(Energies &energies)
    {
      auto &[external, released, contact, stored, friction, plastic, stabilisation, unresolved] = energies;
      for (double *energy : {&external, &released, &contact, &stored, &friction, &plastic, &stabilisation, &unresolved})
        f(*energy);
    }
    void operator()(Vector &v)
    {
      for (const DoFIndex i : v.locally_owned_elements())
      {
        double value = v(i);
        f(value);
        v(i) = value;
      }
      v.compress(dealii::VectorOperation::insert);
    }

    /// Only owned slave nodes and sites have values that are right.
    template <typename T>
    void slaves(std::vector<T> &values)
    {
      for (unsigned int k = 0; k < model.contact->surfaces().n_owned_slave_nodes(); ++k)
        (*this)(values[k]);
    }
    template <typename T>
    void sites(std::vector<T> &values)
    {
      for (unsigned int s = 0; s < values.size(); ++s)
        if (model.contact->surfaces().is_owned(s))
          (*this)(values[s]);
    }
    void operator()(SolidAssembler::History &history)
    {
      model.solid->start_from(history);
      auto values = model.solid->history();
      (*this)(values);
      model.solid->set_history(values);
      history = model.solid->start();
    }
    void operator()(Status::State &statuses)
    {
      auto &[contact, stick, threshold, slip, adjustment, friction_factor, slip_rate, friction_state] = statuses;
      sites(contact);
      sites(stick);
      sites(threshold);
      sites(slip);
      sites(adjustment);
      sites(friction_factor);
      sites(slip_rate);
      sites(friction_state);
    }
    void operator()(InterfaceState &interface)
    {
      auto &[statuses, tangents, elastic_slip, area, force, jump, on_new_mesh, stuck] = interface;
      (*this)(statuses);
      slaves(tangents);
      slaves(elastic_slip);
      slaves(area);
      sites(force);
      sites(jump);
      (*this)(on_new_mesh);
      sites(stuck);
    }
    void operator()(State &state)
    {
      auto &[unknowns, contact, rigid, history, reaction, applied, energies, motion, motion_time, stiffness_scale] =
          state;
      for (unsigned int b = 0; b < unknowns.n_blocks(); ++b)
        (*this)(unknowns.block(b));
      (*this)(contact);
      (*this)(rigid);
      (*this)(history);
      (*this)(reaction);
      (*this)(applied);
      (*this)(energies);
      (*this)(motion);
      (*this)(motion_time);
      (*this)(stiffness_scale);
    }
  };
  template <typename Function>
  void for_each_number(const Model &model, State &state, const Function &f)
  {
    EachNumber<Function>{model, f}(state);
  }

  std::vector<double> numbers(const Model &model, State state)
  {
    std::vector<double> result;
    for_each_number(model, state, [&](double &value) { result.push_back(value); });
    return result;
  }

  void randomise(const Model &model, State &state, const unsigned int seed)
  {
    std::mt19937                           generator(seed + dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    std::uniform_real_distribution<double> random(0., 1.);
    for_each_number(model, state, [&](double &value) { value = random(generator); });
    // the same on all ranks
    unpack_common(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, pack_common(state)), state);
    for (auto &tangents : state.contact.tangents) // frames
    {
      tangents[0] /= tangents[0].norm();
      tangents[1] -= (tangents[1] * tangents[0]) * tangents[0];
      tangents[1] /= tangents[1].norm();
    }
  }

  void report(const std::string &what, const std::vector<double> &a, const std::vector<double> &b)
  {
    double       difference = a.size() == b.size() ? 0. : 1e9;
    unsigned int equal      = 0;
    for (unsigned int i = 0; i < std::min(a.size(), b.size()); ++i)
    {
      difference = std::max(difference, std::abs(a[i] - b[i]));
      equal += a[i] == b[i];
    }
    difference = dealii::Utilities::MPI::max(difference, MPI_COMM_WORLD);
    equal      = dealii::Utilities::MPI::sum(equal, MPI_COMM_WORLD);
    if (root())
      std::cout << "  " << what << ": largest difference " << (difference < 1e-13 ? 0. : difference) << ", the same "
                << equal << std::endl;
  }

  void test(const ContactPairParameters::Scheme scheme)
  {
    Parameters p                           = driven("state_results");
    p.contact_pairs[0].scheme              = scheme;
    p.bodies[0].material.law               = MaterialParameters::Law::j2_plasticity;
    p.bodies[0].material.yield_stress      = 1.;
    p.bodies[0].material.hardening_modulus = 1.;
    p.output.write_vtu                     = false;
    States        states;
    Journal       journal(p, MPI_COMM_WORLD, log());
    Model         model(p, MPI_COMM_WORLD, states);
    Equilibrium   equilibrium(model, journal, states);
    Results       results(model, journal, states, equilibrium);
    Checkpointing checkpointing(model, journal, states, equilibrium, results);
    LoadStepping  path(p.load_stepping);
    journal.tables = std::make_unique<Tables>(p.output.results_folder, MPI_COMM_WORLD, std::vector<std::string>());
    equilibrium.begin_on_mesh();
    model.begin_contact(states, 0.);

    randomise(model, states.now, 1);
    const std::vector<double> expected = numbers(model, states.now);
    if (root())
      std::cout << text_of(scheme) << ": numbers "
                << dealii::Utilities::MPI::sum<unsigned int>(expected.size(), MPI_COMM_WORLD) << std::endl;
    else
      dealii::Utilities::MPI::sum<unsigned int>(expected.size(), MPI_COMM_WORLD);
    const auto scramble = [&] { randomise(model, states.now, 2); };

    states.committed = states.now;
    scramble();
    model.roll_back(states);
    report("roll-back", numbers(model, states.now), expected);

    path.accept(1, true);
    model.roll_back(states);
    checkpointing.write(path);
    scramble();
    states.committed = states.now;
    checkpointing.read(path);
    report("checkpoint", numbers(model, states.now), expected);
    report("checkpoint, committed", numbers(model, states.committed), expected);

    const KeptState kept(states.committed, *model.contact);
    scramble();
    copy_common(states.committed, states.now);
    states.now.history = states.committed.history;
    kept.restore(*model.contact, states.now);
    report("kept while pairs are added", numbers(model, states.now), expected);

    // a transfer keeps what does not refer to areas; statuses are those of own sites, and frames of nodes with a status
    const std::vector<Vector> vectors = interpolable_vectors(states.committed, *model.contact);
    scramble();
    copy_common(states.committed, states.now);
    states.now.history = states.committed.history;
    take_interpolated(vectors, *model.contact, states.now);
    const double area = dealii::Utilities::MPI::max(
        *std::max_element(states.now.contact.area.begin(), states.now.contact.area.end()), MPI_COMM_WORLD);
    unsigned int wrong = 0;
    for (unsigned int s = 0; s < model.contact->surfaces().n_sites(); ++s)
      wrong += model.contact->surfaces().is_owned(s) && !model.contact->surfaces().is_point(s) &&
               model.contact->surfaces().has_status(s) &&
               states.now.contact.stuck[s] != states.committed.contact.statuses.contact[s];
    wrong = dealii::Utilities::MPI::sum(wrong, MPI_COMM_WORLD);
    if (root())
      std::cout << "  transfer: largest area " << area << ", on a new mesh " << states.now.contact.on_new_mesh
                << ", stuck without contact " << wrong << std::endl;
    states.now.contact.area        = states.committed.contact.area;
    states.now.contact.stuck       = states.committed.contact.stuck;
    states.now.contact.on_new_mesh = states.committed.contact.on_new_mesh;
    // frames are made orthogonal anew: their last digits may differ
    const std::vector<double> left       = numbers(model, states.now);
    double                    difference = 0.;
    for (unsigned int i = 0; i < expected.size(); ++i)
      difference = std::max(difference, std::abs(left[i] - expected[i]));
    difference = dealii::Utilities::MPI::max(difference, MPI_COMM_WORLD);
    if (root() && scheme == ContactPairParameters::Scheme::averaged) // points get the means of the nodes
      std::cout << "  transfer, the rest: largest difference " << (difference < 1e-13 ? 0. : difference) << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test(ContactPairParameters::Scheme::averaged);
  test(ContactPairParameters::Scheme::integration_point);
}
