// Cells per second of the element kernel and of the whole tangent of SolidAssembler, beside the same with FEValues and
// SymmetricTensor as in deal.II's step-44, and beside the limits of the machine. Prints a CSV for kernel.py. One core,
// CPU time, the contenders take turns; the least of all rounds counts.

#include "plain_element.h"

#include "bulk/element_kernel.h"
#include "bulk/solid_assembler.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <iostream>
#include <limits>

using namespace Nodus;
using Law = MaterialParameters::Law;

namespace
{
  double cpu_seconds()
  {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
  }

  struct Contender
  {
    std::string           name;
    std::function<void()> run;
    double                best = std::numeric_limits<double>::max();
  };

  void take_turns(std::vector<Contender> &contenders, const unsigned int rounds)
  {
    for (unsigned int r = 0; r < rounds; ++r)
      for (Contender &c : contenders)
      {
        const double start = cpu_seconds();
        c.run();
        c.best = std::min(c.best, cpu_seconds() - start);
      }
  }

  /// STREAM triad: three arrays of 128 MB, 24 bytes an entry (the read before the write is not counted).
  void measure_bandwidth()
  {
    const std::size_t      n = 16000000;
    std::vector<double>    a(n, 0.), b(n, 1.), c(n, 2.);
    std::vector<Contender> triad{{"triad",
                                  [&]
                                  {
                                    for (std::size_t i = 0; i < n; ++i)
                                      a[i] = b[i] + 3. * c[i];
                                    asm volatile("" : : "r"(a.data()) : "memory");
                                  }}};
    take_turns(triad, 10);
    std::cout << "limit,triad [B/s]," << 24. * n / triad[0].best << std::endl;
  }

  /// Independent fused multiply-adds on registers.
  void measure_flops()
  {
    constexpr unsigned int chains = 12, n = 5000000;
    Lanes                  x[chains];
    for (unsigned int k = 0; k < chains; ++k)
      x[k] = Lanes{} + 1. * k;
    std::vector<Contender> fma{{"fma",
                                [&]
                                {
                                  Lanes y[chains];
                                  std::copy_n(x, chains, y);
                                  for (unsigned int i = 0; i < n; ++i)
                                    for (unsigned int k = 0; k < chains; ++k)
                                      y[k] = y[k] * .9 + .1;
                                  std::copy_n(y, chains, x);
                                  asm volatile("" : : "r"(x) : "memory");
                                }}};
    take_turns(fma, 10);
    std::cout << "limit,multiply-add [flop/s]," << 2. * chains * n_lanes * n / fma[0].best << std::endl;
  }

  /// The element kernel of the library on all cells, without the scatter.
  class Elements
  {
  public:
    explicit Elements(const Problem &problem)
        : u_(problem.plain_u)
        , X_(u_.size())
        , kernel_(ElementKernel::make(problem.fe, BodyParameters::VolumetricTreatment::standard))
        , batch_X_(problem.fe.n_dofs_per_cell())
        , batch_u_(batch_X_.size())
        , force(batch_u_.size())
        , stiffness(batch_u_.size() * (batch_u_.size() + dim) / 2)
    {
      dealii::FEValues<dim> values(problem.mapping,
                                   problem.fe,
                                   problem.fe.base_element(0).get_unit_support_points(),
                                   dealii::update_quadrature_points);
      std::vector<DoFIndex> dofs(batch_u_.size());
      n_batches = problem.triangulation.n_active_cells() / n_lanes;
      for (const auto &cell : problem.dof_handler.active_cell_iterators())
      {
        values.reinit(cell);
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < dofs.size(); ++i)
          X_[dofs[i]] = values.quadrature_point(i / dim)[i % dim];
        dofs_.insert(dofs_.end(), dofs.begin(), dofs.end());
      }
    }

    void batch(const unsigned int n, const Material &material)
    {
      const unsigned int *dof = dofs_.data() + n * n_lanes * batch_u_.size();
      for (unsigned int v = 0; v < n_lanes; ++v)
        for (unsigned int i = 0; i < batch_u_.size(); ++i, ++dof)
        {
          batch_X_[i][v] = X_[*dof];
          batch_u_[i][v] = u_(*dof);
        }
      Lanes det_F;
      kernel_->integrate(kernel_->points(batch_X_.data()),
                         material,
                         batch_u_.data(),
                         nullptr,
                         {},
                         force.data(),
                         stiffness.data(),
                         det_F,
                         nullptr);
    }

    /// Entry of the stiffness of the cell in a lane, i and j in the order of the element's degrees of freedom.
    double entry(const unsigned int i, const unsigned int j, const unsigned int lane) const
    {
      const unsigned int a = i / dim, b = j / dim, n = batch_u_.size() / dim;
      if (b < a)
        return entry(j, i, lane);
      return stiffness[(a * n - a * (a + 1) / 2 + b) * dim * dim + i % dim * dim + j % dim][lane];
    }

    unsigned int n_batches;

  private:
    const dealii::Vector<double>  &u_;
    std::vector<double>            X_; ///< positions of the nodes, by degree of freedom
    std::unique_ptr<ElementKernel> kernel_;
    std::vector<unsigned int>      dofs_;
    std::vector<Lanes>             batch_X_, batch_u_;

  public:
    std::vector<Lanes> force, stiffness;
  };

  /// A law that implements evaluate() only, as one would add it first.
  class ByTensors : public Material
  {
  public:
    explicit ByTensors(const Material &law)
        : law_(law)
    {
    }
    void evaluate(const Tensor<2, dim> &F, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const override
    {
      law_.evaluate(F, S, C);
    }
    double energy(const Tensor<2, dim> &F) const override
    {
      return law_.energy(F);
    }
    double youngs_modulus() const override
    {
      return law_.youngs_modulus();
    }

  private:
    const Material &law_;
  };

  struct Named
  {
    const char *name;
    Law         law;
    double      flops; ///< of the law at a point, as written, without logarithm and roots
  };
  constexpr Named laws[] = {{"linear elastic", Law::linear_elastic, 22.},
                            {"St Venant-Kirchhoff", Law::st_venant_kirchhoff, 46.},
                            {"neo-Hookean", Law::neo_hookean, 230.},
                            {"Mooney-Rivlin", Law::mooney_rivlin, 380.}};

  /// Additions and multiplications of HexKernel for n nodes and points.
  double flops(const Named &law, const double n)
  {
    const bool   small    = law.law == Law::linear_elastic;
    const double jacobian = n * 18. + 14. + 37., gradients = n * 15., F = n * 18. + (small ? 0. : 14.),
                 force   = 6. + (small ? 0. : 45.) + n * 18.;
    const double moduli  = small ? 81. : 36. + 270. + 243.;
    const double tangent = moduli + n * 135. + n * (n + 1.) / 2. * 54.;
    return n * (jacobian + gradients + F + law.flops + force + tangent);
  }

  double largest_difference(Elements &elements, Plain &plain, const Problem &problem, const Material &material)
  {
    double difference = 0., largest = 0., force_difference = 0., largest_force = 0.;
    for (const auto &cell : problem.dof_handler.active_cell_iterators())
    {
      const unsigned int c = cell->active_cell_index(), lane = c % n_lanes;
      if (c >= 512)
        break;
      if (lane == 0)
        elements.batch(c / n_lanes, material);
      plain.cell(cell);
      for (unsigned int i = 0; i < plain.force.size(); ++i)
      {
        largest_force    = std::max(largest_force, std::abs(plain.force(i)));
        force_difference = std::max(force_difference, std::abs(plain.force(i) - elements.force[i][lane]));
        for (unsigned int j = 0; j < plain.force.size(); ++j)
        {
          largest    = std::max(largest, std::abs(plain.matrix(i, j)));
          difference = std::max(difference, std::abs(plain.matrix(i, j) - elements.entry(i, j, lane)));
        }
      }
    }
    return std::max(difference / largest, force_difference / largest_force);
  }

  void measure(const unsigned int degree, const unsigned int n, const unsigned int rounds)
  {
    const Problem                                       problem(degree, n);
    std::vector<BoundaryConditions::Load>               loads;
    std::vector<std::vector<std::unique_ptr<Material>>> materials(std::size(laws));
    std::vector<std::unique_ptr<SolidAssembler>>        assemblers;
    std::vector<BlockCsrMatrix>                         tangents(std::size(laws));
    Elements                                            elements(problem);
    MaterialParameters                                  parameters;
    parameters.youngs_modulus      = 1.;
    parameters.poissons_ratio      = 0.3;
    parameters.mooney_rivlin_ratio = 0.4;

    std::vector<Contender> contenders;
    Vector                 rhs, internal, external;
    double                 t = 0.;
    for (unsigned int l = 0; l < std::size(laws); ++l)
    {
      parameters.law = laws[l].law;
      materials[l].push_back(make_material(parameters));
      assemblers.push_back(std::make_unique<SolidAssembler>(problem.dof_handler, problem.mapping, materials[l], loads));
      assemblers[l]->make_sparsity(tangents[l]);
      contenders.push_back({std::string("element,") + laws[l].name,
                            [&, l]
                            {
                              for (unsigned int b = 0; b < elements.n_batches; ++b)
                                elements.batch(b, *materials[l][0]);
                            }});
      // another time each time: the assembler knows the answer for the last displacement and time
      contenders.push_back({std::string("assembled,") + laws[l].name, [&, l] {
                              assemblers[l]->tangent(
                                  problem.u, t += 1., problem.constraints, tangents[l], rhs, internal, external);
                            }});
    }
    const ByTensors neo_hookean_by_tensors(*materials[2][0]);
    contenders.push_back({"element,neo-Hookean by evaluate()",
                          [&]
                          {
                            for (unsigned int b = 0; b < elements.n_batches; ++b)
                              elements.batch(b, neo_hookean_by_tensors);
                          }});

    parameters.law = Law::neo_hookean;
    Plain plain(problem, parameters);
    contenders.push_back({"element,plain deal.II",
                          [&]
                          {
                            for (const auto &cell : problem.dof_handler.active_cell_iterators())
                              plain.cell(cell);
                          }});
    dealii::TrilinosWrappers::SparseMatrix plain_tangent;
    Vector                                 plain_force(problem.u.locally_owned_elements(), MPI_COMM_WORLD);
    {
      dealii::DynamicSparsityPattern sparsity(problem.dof_handler.n_dofs());
      dealii::DoFTools::make_sparsity_pattern(problem.dof_handler, sparsity, problem.constraints, false);
      plain_tangent.reinit(problem.u.locally_owned_elements(), sparsity, MPI_COMM_WORLD);
    }
    contenders.push_back({"assembled,plain deal.II",
                          [&]
                          {
                            std::vector<DoFIndex> dofs(plain.force.size());
                            plain_tangent = 0.;
                            plain_force   = 0.;
                            for (const auto &cell : problem.dof_handler.active_cell_iterators())
                            {
                              plain.cell(cell);
                              cell->get_dof_indices(dofs);
                              problem.constraints.distribute_local_to_global(
                                  plain.matrix, plain.force, dofs, plain_tangent, plain_force);
                            }
                            plain_tangent.compress(dealii::VectorOperation::add);
                            plain_force.compress(dealii::VectorOperation::add);
                          }});

    take_turns(contenders, rounds);

    const double n_cells = problem.triangulation.n_active_cells(), n_nodes = plain.force.size() / dim;
    double       n_blocks = 0.;
    for (unsigned int i = 0; i < tangents[2].map().n_owned(); ++i)
      tangents[2].for_row(i, [&](unsigned int, const double *, const bool transposed) { n_blocks += !transposed; });
    // numbers of the nodes are read, and the stiffness zeroed, read and written, through the memory; the rest stays in
    // caches
    const double numbers  = n_nodes * dim * sizeof(unsigned int);
    const double assembly = 4. * n_nodes + 2. * n_nodes * (n_nodes + 1.) + 3. * 72. * n_blocks / n_cells;
    for (const Contender &c : contenders)
    {
      const Named *const law = std::find_if(
          std::begin(laws), std::end(laws), [&](const Named &l) { return c.name.find(l.name) != std::string::npos; });
      const bool plain_deal = law == std::end(laws) || c.name.find("evaluate") != std::string::npos;
      std::cout << degree << ',' << c.name << ',' << n_cells / c.best << ',';
      if (!plain_deal)
        std::cout << flops(*law, n_nodes) << ',' << (c.name[0] == 'e' ? numbers : assembly);
      else
        std::cout << ',';
      std::cout << std::endl;
    }

    // relative differences of the results: element by element, and of the product with a vector of the assembled matrix
    Vector x(problem.u), y(x), z(x);
    tangents[2].vmult(y.begin(), x.begin());
    plain_tangent.vmult(z, x);
    z -= y;
    const double elementwise = largest_difference(elements, plain, problem, *materials[2][0]);
    assemblers[2]->tangent(problem.u, -1., problem.constraints, tangents[2], rhs, internal, external);
    contenders.back().run();
    plain_force -= internal;
    const double product =
        std::max(z.linfty_norm() / y.linfty_norm(), plain_force.linfty_norm() / internal.linfty_norm());
    std::cout << degree << ",difference,element," << elementwise << '\n'
              << degree << ",difference,assembled," << product << std::endl;
    if (!(elementwise < 1e-12 && product < 1e-12))
      throw std::runtime_error("the kernels do not agree");
  }
} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                             rounds = argc > 1 ? std::stoi(argv[1]) : 7;
  measure_bandwidth();
  measure_flops();
  measure(1, 32, rounds);
  measure(2, 16, rounds);
}
