#include "output/vtu.h"
#include "base/complete_file.h"
#include "base/deal_ii_versions.h"
#include "bulk/nodal_stress.h"
#include "output/vtu_patches.h"
#include "parallel/throw_everywhere.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_values_extractors.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <cmath>
#include <map>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    /// @param plastic some body has an equivalent plastic strain
    std::vector<PatchField> body_fields(const bool plastic)
    {
      std::vector<PatchField> fields = {
          {"displacement", dim}, {"cauchy_stress", dim * dim}, {"von_mises", 1}, {"body", 1}};
      if (plastic)
        fields.push_back({"PEEQ", 1});
      return fields;
    }

    const std::vector<PatchField> contact_fields = {{"CPRESS", 1},
                                                    {"COPEN", 1},
                                                    {"CSHEAR1", 1},
                                                    {"CSHEAR2", 1},
                                                    {"CSLIP1", 1},
                                                    {"CSLIP2", 1},
                                                    {"CSTATUS", 1},
                                                    {"paired", 1},
                                                    {"pair", 1},
                                                    {"normal", dim},
                                                    {"tangent1", dim},
                                                    {"friction_traction", dim},
                                                    {"displacement", dim},
                                                    {"area", 1},
                                                    {"status_changes", 1},
                                                    {"cycle_period", 1},
                                                    {"contradiction", 1}};

    /// A file that @p write fills, complete or not at all. @returns what went wrong.
    template <typename Write>
    std::string write_complete(const std::string &folder, const std::string &name, const Write &write)
    {
      CompleteFile file(folder, name);
      try
      {
        write(file.stream());
      }
      catch (const ExcIO &)
      {
        // deal.II found the stream in a bad state, and so does finish(), which has more to say
      }
      return file.finish();
    }

    double von_mises(const SymmetricTensor<2, dim> &stress)
    {
      return std::sqrt(1.5) * deviator(stress).norm();
    }
  } // namespace

  struct VtuOutput::Implementation
  {
    std::string            folder;
    const Bodies          &bodies;
    const DoFHandler<dim> &dof_handler;
    const Mapping<dim>    &mapping;
    const SolidAssembler  &solid;
    bool                   by_increment;

    MPI_Comm     communicator = communicator_of(bodies.triangulation());
    unsigned int rank         = Utilities::MPI::this_mpi_process(communicator);
    unsigned int n_ranks      = Utilities::MPI::n_mpi_processes(communicator);
    unsigned int degree       = dof_handler.get_fe().degree;

    Series written = {};

    template <typename Function>
    void        for_nodes(const Vector &u, PatchOutput<dim> &output, const Function &f) const;
    void        add_bodies(const Vector &u, PatchOutput<dim> &output) const;
    void        add_contact(const std::vector<ContactFields> &contact, PatchOutput<dim - 1> &output) const;
    void        add_state(const Vector                  &u,
                          const std::vector<NodalField> &fields,
                          const std::vector<float>      &det_F,
                          PatchOutput<dim>              &output) const;
    std::string main_file(const std::string &stem) const;
    template <int patch_dim>
    void write_pieces(const std::string &stem, const PatchOutput<patch_dim> &output) const;
    template <int patch_dim>
    void write(const std::string &series, unsigned int increment, double t, const PatchOutput<patch_dim> &output);
    std::string write_record(const std::string &series) const;
  };

  /// Calls f(cell, patch, node, j, dofs of the node) for the nodes of the owned cells, in the order of the patch, and
  /// adds their positions at displacement @p u.
  template <typename Function>
  void VtuOutput::Implementation::for_nodes(const Vector &u, PatchOutput<dim> &output, const Function &f) const
  {
    const auto        &fe      = dof_handler.get_fe();
    const auto         to_node = FETools::lexicographic_to_hierarchic_numbering<dim>(degree);
    const unsigned int n_nodes = to_node.size();
    std::vector<Point> unit_nodes(n_nodes);
    for (unsigned int j = 0; j < n_nodes; ++j)
      unit_nodes[j] = fe.unit_support_point(fe.component_to_system_index(0, to_node[j]));
    FEValues<dim> nodes(mapping, fe, Quadrature<dim>(unit_nodes), update_quadrature_points);

    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && bodies.has_mesh(cell->material_id()))
      {
        nodes.reinit(cell);
        cell->get_dof_indices(dofs);
        auto &patch = output.add_patch(degree);
        for (unsigned int j = 0; j < n_nodes; ++j)
        {
          std::array<types::global_dof_index, dim> node_dofs;
          Tensor<1, dim>                           u_j;
          for (unsigned int c = 0; c < dim; ++c)
          {
            node_dofs[c] = dofs[fe.component_to_system_index(c, to_node[j])];
            u_j[c]       = u(node_dofs[c]);
          }
          PatchColumn column(patch.data, j);
          column << u_j;
          f(cell, node_dofs, column);
          column << nodes.quadrature_point(j) + u_j;
        }
      }
  }

  void VtuOutput::Implementation::add_bodies(const Vector &u, PatchOutput<dim> &output) const
  {
    const NodalStress values(dof_handler, mapping, solid, u);
    for_nodes(u,
              output,
              [&](const auto &cell, const auto &dofs, PatchColumn &column)
              {
                const SymmetricTensor<2, dim> sigma = values.stress(dofs[0]);
                column << sigma << von_mises(sigma) << cell->material_id() + 1.;
                if (values.has_plastic_strain())
                  column << values.plastic_strain(dofs[0]);
              });
  }

  void VtuOutput::Implementation::add_state(const Vector                  &u,
                                            const std::vector<NodalField> &fields,
                                            const std::vector<float>      &det_F,
                                            PatchOutput<dim>              &output) const
  {
    for_nodes(u,
              output,
              [&](const auto &cell, const auto &dofs, PatchColumn &column)
              {
                column << cell->material_id() + 1. << det_F[cell->active_cell_index()];
                for (const NodalField &field : fields)
                  for (const auto dof : dofs)
                    column << field.values(dof);
              });
  }

  void VtuOutput::Implementation::add_contact(const std::vector<ContactFields> &contact,
                                              PatchOutput<dim - 1>             &output) const
  {
    for (unsigned int p = 0; p < contact.size(); ++p)
      for (const auto &face : contact[p].faces)
      {
        const auto &c     = contact[p];
        auto       &patch = output.add_patch(c.degree);
        for (unsigned int j = 0; j < face.size(); ++j)
        {
          const unsigned int k = face[j];
          PatchColumn(patch.data, j) << c.pressure[k] << c.gap[k] << c.shear[0][k] << c.shear[1][k] << c.slip[0][k]
                                     << c.slip[1][k] << static_cast<unsigned int>(c.status[k]) << c.paired[k] << p + 1.
                                     << c.normal[k] << c.tangent1[k] << c.friction[k] << c.displacement[k] << c.area[k]
                                     << c.status_changes[k] << c.cycle_period[k] << int(c.contradiction[k])
                                     << c.X[k] + c.displacement[k];
        }
      }
  }

  std::string VtuOutput::Implementation::main_file(const std::string &stem) const
  {
    return stem + (n_ranks == 1 ? ".vtu" : ".pvtu");
  }

  /// One piece per rank (deal.II 9.4 distorts second-order cells when pieces share a file), then the record of the
  /// pieces.
  template <int patch_dim>
  void VtuOutput::Implementation::write_pieces(const std::string &stem, const PatchOutput<patch_dim> &output) const
  {
    const auto piece = [&](const unsigned int r)
    { return stem + (n_ranks == 1 ? "" : '.' + Utilities::int_to_string(r, 4)) + ".vtu"; };

    throw_everywhere<InputError>(write_complete(folder, piece(rank), [&](std::ostream &out) { output.write_vtu(out); }),
                                 communicator);
    if (n_ranks == 1)
      return;
    std::vector<std::string> pieces(n_ranks);
    for (unsigned int r = 0; r < n_ranks; ++r)
      pieces[r] = piece(r);
    throw_everywhere<InputError>(
        rank > 0 ? ""
                 : write_complete(
                       folder, main_file(stem), [&](std::ostream &out) { output.write_pvtu_record(out, pieces); }),
        communicator);
  }

  /// The pieces before the time series: whoever finds a file finds everything that it refers to.
  template <int patch_dim>
  void VtuOutput::Implementation::write(const std::string            &series,
                                        const unsigned int            increment,
                                        const double                  t,
                                        const PatchOutput<patch_dim> &output)
  {
    const std::string stem = series + '_' + Utilities::int_to_string(increment, 4);
    write_pieces(stem, output);
    written[series].emplace_back(by_increment ? increment : t, main_file(stem));
    throw_everywhere<InputError>(rank == 0 ? write_record(series) : "", communicator);
  }

  /// @returns what went wrong.
  std::string VtuOutput::Implementation::write_record(const std::string &series) const
  {
    return write_complete(
        folder, series + ".pvd", [&](std::ostream &out) { DataOutBase::write_pvd_record(out, written.at(series)); });
  }

  VtuOutput::VtuOutput(const std::string     &folder,
                       const Bodies          &bodies,
                       const DoFHandler<dim> &dof_handler,
                       const Mapping<dim>    &mapping,
                       const SolidAssembler  &solid,
                       const bool             by_increment)
      : implementation_(new Implementation{folder, bodies, dof_handler, mapping, solid, by_increment})
  {
  }

  VtuOutput::~VtuOutput() = default;

  const VtuOutput::Series &VtuOutput::series() const
  {
    return implementation_->written;
  }

  void VtuOutput::continue_from(const Series &series)
  {
    implementation_->written = series;
    std::string problem;
    if (implementation_->rank == 0)
      for (const auto &one : series)
        if (problem.empty())
          problem = implementation_->write_record(one.first);
    throw_everywhere<InputError>(problem, implementation_->communicator);
  }

  void VtuOutput::write(const unsigned int                increment,
                        const double                      t,
                        const Vector                     &u,
                        const std::vector<ContactFields> &contact)
  {
    PatchOutput<dim> body_output(body_fields(implementation_->solid.has_history()), implementation_->degree, t);
    implementation_->add_bodies(u, body_output);
    implementation_->write("bodies", increment, t, body_output);

    if (!contact.empty())
    {
      PatchOutput<dim - 1> contact_output(contact_fields, implementation_->degree, t);
      implementation_->add_contact(contact, contact_output);
      implementation_->write("contact", increment, t, contact_output);
    }
  }

  void VtuOutput::write_state(const std::string             &name,
                              const double                   t,
                              const Vector                  &u,
                              const std::vector<NodalField> &fields,
                              const std::vector<float>      &det_F)
  {
    std::vector<PatchField> columns = {{"displacement", dim}, {"body", 1}, {"det_F", 1}};
    for (const NodalField &field : fields)
      for (const std::string &column : field.names)
        columns.push_back({column, field.names.size() == 1 ? dim : 1});
    PatchOutput<dim> output(columns, implementation_->degree, t);
    implementation_->add_state(u, fields, det_F, output);
    implementation_->write_pieces(name, output);
  }

  std::string VtuOutput::state_file(const std::string &name) const
  {
    return implementation_->main_file(name);
  }
} // namespace Nodus
