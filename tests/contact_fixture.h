#ifndef nodus_tests_contact_fixture_h
#define nodus_tests_contact_fixture_h

// The contact objects of two boxes, without bulk, Newton or loops: statuses, positions and multipliers are set by hand.

#include "cases.h"

#include "contact/contact_assembler.h"
#include "mesh/bodies.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/la_parallel_vector.h>

struct ContactFixture
{
  ContactFixture(const std::vector<Nodus::BodyParameters>        &body_parameters,
                 const std::vector<Nodus::ContactPairParameters> &pair_parameters,
                 const unsigned int                               degree)
      : pairs(pair_parameters)
      , bodies(body_parameters, MPI_COMM_WORLD)
      , mapping(degree)
      , fe(dealii::FE_Q<3>(degree), 3)
      , dof_handler(bodies.triangulation())
  {
    dof_handler.distribute_dofs(fe);
    surfaces = std::make_unique<Nodus::ContactSurfaces>(pairs, bodies, dof_handler, mapping);
    for (unsigned int p = 0; p < pairs.size(); ++p)
      pairs[p].normal_augmentation_factor = normal_augmentation * surfaces->face_size(p);
    status =
        std::make_unique<Nodus::Status>(pairs, *surfaces, std::vector<double>(pairs.size(), 1.), strategy, statuses);
    assembler = std::make_unique<Nodus::ContactAssembler>(*surfaces, pairing, jump, weights, *status);

    const std::vector<Nodus::Vector3> zero(surfaces->nodes().size());
    state.x          = surfaces->positions(zero);
    state.increment  = zero;
    state.prescribed = zero;
    state.lambda.assign(surfaces->slave_nodes().size(), 0.);
    state.Lambda.assign(surfaces->slave_nodes().size(), {{0., 0.}});
    state.elastic_slip.assign(surfaces->slave_nodes().size(), Nodus::Vector3());
    system.layout = &surfaces->layout();
    pair_at(state.x);
  }

  void pair_at(const std::vector<Nodus::Point> &x)
  {
    paired_at = x;
    geometry  = std::make_unique<Nodus::ContactGeometry>(pairs, *surfaces, paired_at);
    averaged.compute(pairs, *surfaces, *geometry, x, x);
    pairing.project(pairs, *surfaces, *geometry, averaged);
    jump.build(pairs, *surfaces, *geometry, pairing, averaged, *status);
    weights.compute(pairs, *surfaces, averaged, x, x);
  }

  Nodus::ContactResidual assemble(const bool linearise_threshold = false)
  {
    surfaces->layout().reinit(system.rhs);
    return assembler->assemble(state, system, linearise_threshold);
  }

  /// The contact couplings as a dense matrix in flat indices.
  dealii::FullMatrix<double> matrix() const
  {
    dealii::FullMatrix<double> K(surfaces->layout().size(), surfaces->layout().size());
    for (const auto *part : {&system.contact, &system.variation})
      for (unsigned int i = 0; i < part->value.size(); ++i)
        K(part->row[i], part->column[i]) += part->value[i];
    return K;
  }

  static constexpr double normal_augmentation = 7.;

  std::vector<Nodus::ContactPairParameters> pairs;
  Nodus::Bodies                             bodies;
  dealii::MappingQ<3>                       mapping;
  dealii::FESystem<3>                       fe;
  dealii::DoFHandler<3>                     dof_handler;
  std::unique_ptr<Nodus::ContactSurfaces>   surfaces;
  std::vector<Nodus::Point>                 paired_at;
  std::unique_ptr<Nodus::ContactGeometry>   geometry;
  Nodus::AveragedJump                       averaged;
  Nodus::Pairing                            pairing;
  Nodus::JumpOperator                       jump;
  Nodus::SurfaceWeights                     weights;
  Nodus::StrategyParameters                 strategy;
  Nodus::Status::State                      statuses;
  std::unique_ptr<Nodus::Status>            status;
  std::unique_ptr<Nodus::ContactAssembler>  assembler;
  Nodus::ContactState                       state;
  Nodus::LinearSystem                       system;
};

#endif
