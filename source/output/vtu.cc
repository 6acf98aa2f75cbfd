#include "output/vtu.h"
#include "base/complete_file.h"
#include "base/deal_ii_versions.h"
#include "bulk/nodal_stress.h"
#include "output/vtu_fields.h"
#include "output/vtu_grid.h"
#include "parallel/throw_everywhere.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_values_extractors.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <filesystem>
#include <map>
#include <unordered_map>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
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
  } // namespace

  struct VtuOutput::Implementation
  {
    OutputParameters       parameters;
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

    bool deformed() const
    {
      return parameters.configuration == OutputParameters::Configuration::deformed;
    }

    VtuGrid bodies_grid(double t) const;
    template <typename AtNode>
    void        add_cells(const Vector &u, VtuGrid &grid, bool shared, const AtNode &at_node) const;
    void        add_bodies(const Vector &u, VtuGrid &grid) const;
    void        add_contact(const std::vector<ContactFields> &contact, VtuGrid &grid) const;
    void        add_state(const Vector                  &u,
                          const std::vector<NodalField> &fields,
                          const std::vector<float>      &det_F,
                          VtuGrid                       &grid) const;
    std::string main_file(const std::string &stem) const;
    void        write_pieces(const std::string &stem, const VtuGrid &grid) const;
    void        write(const std::string &series, unsigned int increment, double t, const VtuGrid &grid);
    std::string write_record(const std::string &series) const;
  };

  VtuGrid VtuOutput::Implementation::bodies_grid(const double t) const
  {
    VtuGrid grid(dim, degree, t, deformed());
    grid.point_data = {{"displacement", dim}, {"body", 1}};
    return grid;
  }

  /// Adds the owned cells to a bodies_grid(), with what that has, and calls at_node(cell, place of the node in the
  /// cell, its degrees of freedom) for each new point. @p shared: cells share their nodes.
  template <typename AtNode>
  void
  VtuOutput::Implementation::add_cells(const Vector &u, VtuGrid &grid, const bool shared, const AtNode &at_node) const
  {
    const auto        &fe      = dof_handler.get_fe();
    const auto         to_node = FETools::lexicographic_to_hierarchic_numbering<dim>(degree);
    const unsigned int n_nodes = to_node.size();
    std::vector<Point> unit_nodes(n_nodes);
    for (unsigned int j = 0; j < n_nodes; ++j)
      unit_nodes[j] = fe.unit_support_point(fe.component_to_system_index(0, to_node[j]));
    FEValues<dim> positions(mapping, fe, Quadrature<dim>(unit_nodes), update_quadrature_points);

    std::vector<DoFIndex>                      dofs(fe.n_dofs_per_cell());
    std::unordered_map<DoFIndex, std::int32_t> point_of; // by the first degree of freedom
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && bodies.has_mesh(cell->material_id()))
      {
        positions.reinit(cell);
        cell->get_dof_indices(dofs);
        grid.cell_ids.push_back(cell->global_active_cell_index());
        for (unsigned int j = 0; j < n_nodes; ++j)
        {
          std::array<DoFIndex, dim> node;
          for (unsigned int c = 0; c < dim; ++c)
            node[c] = dofs[fe.component_to_system_index(c, to_node[j])];
          const std::int32_t next  = grid.n_points();
          const std::int32_t point = shared ? point_of.emplace(node[0], next).first->second : next;
          grid.nodes.push_back(point);
          if (point < next)
            continue;
          const Vector3 u_j({u(node[0]), u(node[1]), u(node[2])});
          grid.points << Vector3(positions.quadrature_point(j)) + (deformed() ? u_j : Vector3());
          grid.node_ids.push_back(node[0] / dim);
          grid.point_data[0] << u_j;
          grid.point_data[1] << cell->material_id() + 1.;
          at_node(cell, j, node);
        }
      }
  }

  void VtuOutput::Implementation::add_bodies(const Vector &u, VtuGrid &grid) const
  {
    const auto        fields = chosen_body_fields(parameters.fields, solid.has_history());
    const std::size_t first  = grid.point_data.size();
    for (const auto &field : fields)
      grid.point_data.emplace_back(field.name, field.components);
    const auto add = [&](const StressAndStrain &values)
    {
      const BodyNode node(values);
      for (std::size_t f = 0; f < fields.size(); ++f)
        fields[f].write(node, grid.point_data[first + f]);
    };
    if (parameters.nodal_values == OutputParameters::NodalValues::by_cell)
    {
      const CellStress values(dof_handler, solid, u);
      add_cells(u,
                grid,
                false,
                [&](const auto &cell, const unsigned int j, const auto &)
                { add(values.at(cell->active_cell_index(), j)); });
    }
    else
    {
      const bool with_strains =
          is_chosen(parameters.fields, "green_lagrange_strain") || is_chosen(parameters.fields, "logarithmic_strain");
      const NodalStress values(dof_handler, solid, u, with_strains);
      add_cells(u, grid, true, [&](const auto &, unsigned int, const auto &node) { add(values.at(node[0])); });
    }
  }

  void VtuOutput::Implementation::add_state(const Vector                  &u,
                                            const std::vector<NodalField> &fields,
                                            const std::vector<float>      &det_F,
                                            VtuGrid                       &grid) const
  {
    for (const NodalField &field : fields)
      for (const std::string &name : field.names)
        grid.point_data.emplace_back(name, field.names.size() == 1 ? dim : 1);
    add_cells(u,
              grid,
              true,
              [&](const auto &, unsigned int, const auto &node)
              {
                unsigned int array = 2;
                for (const NodalField &field : fields)
                  for (unsigned int c = 0; c < dim; ++c)
                  {
                    grid.point_data[array] << field.values(node[c]);
                    array += field.names.size() > 1 || c + 1 == dim;
                  }
              });
    grid.cell_data.emplace_back("det_F", 1);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && bodies.has_mesh(cell->material_id()))
        grid.cell_data.back() << det_F[cell->active_cell_index()];
  }

  void VtuOutput::Implementation::add_contact(const std::vector<ContactFields> &contact, VtuGrid &grid) const
  {
    const auto fields = chosen_contact_fields(parameters.fields);
    grid.point_data   = {{"displacement", dim}, {"pair", 1}};
    for (const auto &field : fields)
      grid.point_data.emplace_back(field.name, field.components);
    for (unsigned int p = 0; p < contact.size(); ++p)
    {
      const ContactFields      &c = contact[p];
      std::vector<std::int32_t> point_of(c.X.size(), -1);
      for (const auto &face : c.faces)
        for (const unsigned int k : face)
        {
          if (point_of[k] < 0)
          {
            point_of[k] = grid.n_points();
            grid.points << Vector3(c.X[k]) + (deformed() ? c.displacement[k] : Vector3());
            grid.node_ids.push_back(c.node[k]);
            grid.point_data[0] << c.displacement[k];
            grid.point_data[1] << p + 1.;
            for (std::size_t f = 0; f < fields.size(); ++f)
              fields[f].write({c, k}, grid.point_data[2 + f]);
          }
          grid.nodes.push_back(point_of[k]);
        }
    }
  }

  std::string VtuOutput::Implementation::main_file(const std::string &stem) const
  {
    return stem + (n_ranks == 1 ? ".vtu" : ".pvtu");
  }

  /// One piece per rank, then the record of the pieces.
  void VtuOutput::Implementation::write_pieces(const std::string &stem, const VtuGrid &grid) const
  {
    const auto piece = [&](const unsigned int r)
    { return stem + (n_ranks == 1 ? "" : '.' + Utilities::int_to_string(r, 4)) + ".vtu"; };

    throw_everywhere<InputError>(
        write_complete(parameters.results_folder, piece(rank), [&](std::ostream &out) { grid.write(out); }),
        communicator);
    if (n_ranks == 1)
      return;
    std::vector<std::string> pieces(n_ranks);
    for (unsigned int r = 0; r < n_ranks; ++r)
      pieces[r] = piece(r);
    throw_everywhere<InputError>(rank > 0 ? ""
                                          : write_complete(parameters.results_folder,
                                                           main_file(stem),
                                                           [&](std::ostream &out) { grid.write_record(out, pieces); }),
                                 communicator);
  }

  /// The pieces before the time series: whoever finds a file finds everything that it refers to.
  void VtuOutput::Implementation::write(const std::string &series,
                                        const unsigned int increment,
                                        const double       t,
                                        const VtuGrid     &grid)
  {
    const std::string stem = series + '_' + Utilities::int_to_string(increment, 4);
    write_pieces(stem, grid);
    written[series].emplace_back(by_increment ? increment : t, main_file(stem));
    throw_everywhere<InputError>(rank == 0 ? write_record(series) : "", communicator);
  }

  /// @returns what went wrong.
  std::string VtuOutput::Implementation::write_record(const std::string &series) const
  {
    return write_complete(parameters.results_folder,
                          series + ".pvd",
                          [&](std::ostream &out) { DataOutBase::write_pvd_record(out, written.at(series)); });
  }

  VtuOutput::VtuOutput(const OutputParameters &parameters,
                       const Bodies           &bodies,
                       const DoFHandler<dim>  &dof_handler,
                       const Mapping<dim>     &mapping,
                       const SolidAssembler   &solid,
                       const bool              by_increment)
      : implementation_(new Implementation{parameters, bodies, dof_handler, mapping, solid, by_increment})
  {
  }

  VtuOutput::~VtuOutput() = default;

  const VtuOutput::Series &VtuOutput::series() const
  {
    return implementation_->written;
  }

  void VtuOutput::continue_from(const Series &series)
  {
    // those that a run in between has removed are left out
    Series there;
    for (const auto &[name, files] : series)
      for (const auto &file : files)
        if (std::filesystem::exists(std::filesystem::path(implementation_->parameters.results_folder) / file.second))
          there[name].push_back(file);
    implementation_->written = Utilities::MPI::broadcast(implementation_->communicator, there);
    std::string problem;
    if (implementation_->rank == 0)
      for (const auto &one : implementation_->written)
        if (problem.empty())
          problem = implementation_->write_record(one.first);
    throw_everywhere<InputError>(problem, implementation_->communicator);
  }

  void VtuOutput::write(const unsigned int                increment,
                        const double                      t,
                        const Vector                     &u,
                        const std::vector<ContactFields> &contact)
  {
    VtuGrid body_grid = implementation_->bodies_grid(t);
    implementation_->add_bodies(u, body_grid);
    implementation_->write("bodies", increment, t, body_grid);

    if (!contact.empty())
    {
      VtuGrid contact_grid(dim - 1, implementation_->degree, t, implementation_->deformed());
      implementation_->add_contact(contact, contact_grid);
      implementation_->write("contact", increment, t, contact_grid);
    }
  }

  void VtuOutput::write_state(const std::string             &name,
                              const double                   t,
                              const Vector                  &u,
                              const std::vector<NodalField> &fields,
                              const std::vector<float>      &det_F)
  {
    VtuGrid grid = implementation_->bodies_grid(t);
    implementation_->add_state(u, fields, det_F, grid);
    implementation_->write_pieces(name, grid);
  }

  std::string VtuOutput::state_file(const std::string &name) const
  {
    return implementation_->main_file(name);
  }
} // namespace Nodus
