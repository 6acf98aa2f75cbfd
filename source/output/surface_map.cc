#include "output/surface_map.h"
#include "base/complete_file.h"
#include "base/deal_ii_versions.h"
#include "mesh/region.h"
#include "mesh/sides.h"
#include "output/vtu_grid.h"
#include "parallel/throw_everywhere.h"
#include "parameters/general_contact.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/fe_tools.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <unordered_map>

namespace Nodus
{
  namespace
  {
    using Type = BoundaryConditionParameters::Type;

    /// What a face may be to the case.
    struct Role
    {
      std::string           name;
      std::optional<Region> region; ///< none of a rigid master, which is opposite to the faces of the role before
      bool                  on_cells = false, on_nodes = false;
      unsigned int          pair    = 0; ///< of the rigid master
      unsigned int          carrier = 0; ///< number of the body that carries it; 0: none
    };

    /// What names may have that XML does not take as it is.
    std::string for_xml(const std::string &text)
    {
      std::string escaped;
      for (const char c : text)
        escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
      return escaped;
    }

    std::vector<Role> roles_of(const Parameters &parameters, const Bodies &bodies)
    {
      std::vector<Role> roles;
      for (unsigned int p = 0; p < parameters.contact_pairs.size(); ++p)
      {
        const auto       &pair   = parameters.contact_pairs[p];
        const std::string number = std::to_string(p + 1);
        const std::string name =
            "contact pair " + number + in_brackets(pair.name == "pair " + number ? "" : pair.name) + ", ";
        roles.push_back({name + (pair.self_contact ? "both sides" : "slave"), Region(pair.slave, bodies, name)});
        if (pair.has_rigid_master())
          roles.push_back(
              {name + "master", {}, false, false, p, pair.master.bodies.empty() ? 0 : pair.master.bodies[0]});
        else if (const RegionParameters master = pair.self_contact ? master_alone(pair) : pair.master;
                 !master.bodies.empty())
          roles.push_back({name + "master", Region(master, bodies, name)});
      }
      for (unsigned int n = 0; n < parameters.boundary_conditions.size(); ++n)
      {
        const auto &condition = parameters.boundary_conditions[n];
        if (condition.at_point())
          continue; // is on no face
        const bool        on_cells = condition.type == Type::body_force;
        const std::string name = "boundary condition " + std::to_string(n + 1) + in_brackets(condition.name) + ", " +
                                 text_of(condition.type);
        roles.push_back({name, Region(condition.region, bodies, name, on_cells), on_cells, condition.holds()});
      }
      return roles;
    }

    /// Faces of a rank, and the roles of each and of its nodes.
    struct Faces
    {
      std::vector<DoFIndex> nodes;      ///< of each face, lexicographic, seen from outside
      std::vector<double>   X;          ///< of these
      std::vector<double>   numbers;    ///< body and boundary id of each face
      std::vector<char>     roles;      ///< of each face, by role
      std::vector<char>     node_roles; ///< of its nodes

      /// What of the rigid master of role @p r is opposite to the face at the positions @p at, if it has a point
      /// opposite to each of them. @p first: of the numbers of its points, which are those of the nodes from there on.
      void add_opposite(const std::vector<Role>     &all,
                        const unsigned int           r,
                        const std::vector<DoFIndex> &face,
                        const std::vector<Point>    &at,
                        const DoFIndex               first,
                        const RigidMasters          &rigid)
      {
        std::vector<Point> opposite;
        for (const Point &x : at)
          if (const std::optional<Point> closest = rigid(all[r].pair, x))
            opposite.push_back(*closest);
        if (opposite.size() != at.size())
          return;
        const unsigned int n = static_cast<unsigned int>(std::lround(std::sqrt(at.size())));
        for (unsigned int j = 0; j < at.size(); ++j)
        {
          const unsigned int back = n - 1 - j % n + n * (j / n); // seen from the slave
          nodes.push_back(first + face[back]);
          for (unsigned int c = 0; c < dim; ++c)
            X.push_back(opposite[back][c]);
        }
        numbers.push_back(all[r].carrier);
        numbers.push_back(-1.);
        for (unsigned int i = 0; i < all.size(); ++i)
          roles.push_back(i == r);
        node_roles.insert(node_roles.end(), all.size() * at.size(), 0);
      }
    };

    Faces owned_faces(const std::vector<Role>       &roles,
                      const Bodies                  &bodies,
                      const dealii::DoFHandler<dim> &dof_handler,
                      const dealii::Mapping<dim>    &mapping,
                      const RigidMasters            &rigid)
    {
      const auto           &fe      = dof_handler.get_fe();
      const auto           &scalar  = fe.base_element(0);
      const unsigned int    n       = fe.degree + 1;
      const auto            to_node = dealii::FETools::lexicographic_to_hierarchic_numbering<dim>(fe.degree);
      const unsigned int    step[3] = {1, n, n * n};
      std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
      Faces                 faces;
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned() && bodies.has_mesh(cell->material_id()))
          for (const unsigned int f : cell->face_indices())
          {
            if (!cell->at_boundary(f))
              continue;
            cell->get_dof_indices(dofs);
            std::vector<Point>    X;
            std::vector<DoFIndex> nodes;
            for (unsigned int j = 0; j < n * n; ++j)
            {
              const unsigned int a = f % 2 == 1 ? j % n : j / n, b = f % 2 == 1 ? j / n : j % n;
              const unsigned int node =
                  to_node[f % 2 * (n - 1) * step[f / 2] + a * step[(f / 2 + 1) % dim] + b * step[(f / 2 + 2) % dim]];
              X.push_back(mapping.transform_unit_to_real_cell(cell, scalar.unit_support_point(node)));
              nodes.push_back(dofs[fe.component_to_system_index(0, node)] / dim);
              for (unsigned int c = 0; c < dim; ++c)
                faces.X.push_back(X[j][c]);
            }
            faces.nodes.insert(faces.nodes.end(), nodes.begin(), nodes.end());
            faces.numbers.push_back(cell->material_id() + 1.);
            faces.numbers.push_back(cell->face(f)->boundary_id());
            const std::size_t first = faces.roles.size();
            for (const Role &role : roles)
            {
              const bool        held_there = role.on_nodes && role.region->contains_face(cell, f);
              const Vector3     normal     = held_there ? role.region->normal(mapping, cell, f) : Vector3();
              std::vector<char> held(n * n, 0);
              for (unsigned int j = 0; held_there && j < n * n; ++j)
                held[j] = role.region->contains_point(X[j], normal);
              faces.node_roles.insert(faces.node_roles.end(), held.begin(), held.end());
              faces.roles.push_back(!role.region    ? false
                                    : role.on_nodes ? std::count(held.begin(), held.end(), 1) == n * n
                                    : role.on_cells ? role.region->selects_cell(mapping, cell)
                                                    : role.region->selects_face(mapping, cell, f));
            }
            for (unsigned int r = 1; r < roles.size(); ++r)
              if (!roles[r].region && faces.roles[first + r - 1])
                faces.add_opposite(roles, r, nodes, X, r * (dof_handler.n_dofs() / dim), rigid);
          }
      return faces;
    }

    /// Values of cells and points, by role, for the faces that follow.
    VtuGrid empty_grid(const std::vector<Role> &roles, const unsigned int degree)
    {
      VtuGrid grid(dim - 1, degree, 0., true);
      grid.cell_data = {{"body", 1}, {"boundary_id", 1}};
      for (const Role &role : roles)
      {
        grid.cell_data.emplace_back(for_xml(role.name), 1);
        if (role.on_nodes)
          grid.point_data.emplace_back(for_xml(role.name), 1);
      }
      return grid;
    }

    /// @p point_of: points that the grid has, by node.
    void add(const Faces                                &faces,
             const std::vector<Role>                    &roles,
             const unsigned int                          nodes_per_face,
             std::unordered_map<DoFIndex, std::int32_t> &point_of,
             VtuGrid                                    &grid)
    {
      const std::size_t n_faces = faces.nodes.size() / nodes_per_face;
      for (std::size_t i = 0; i < faces.nodes.size(); ++i)
      {
        const auto [entry, is_new] = point_of.emplace(faces.nodes[i], grid.n_points());
        grid.nodes.push_back(entry->second);
        if (!is_new)
          continue;
        grid.points << faces.X[dim * i] << faces.X[dim * i + 1] << faces.X[dim * i + 2];
        grid.node_ids.push_back(faces.nodes[i]);
        for (auto &array : grid.point_data)
          array << 0.;
      }
      for (std::size_t face = 0; face < n_faces; ++face)
      {
        grid.cell_data[0] << faces.numbers[2 * face];
        grid.cell_data[1] << faces.numbers[2 * face + 1];
        unsigned int array = 0; // of points
        for (unsigned int r = 0; r < roles.size(); ++r)
        {
          grid.cell_data[2 + r] << faces.roles[face * roles.size() + r];
          for (unsigned int j = 0; roles[r].on_nodes && j < nodes_per_face; ++j)
            if (faces.node_roles[(face * roles.size() + r) * nodes_per_face + j])
              grid.point_data[array].values[point_of.at(faces.nodes[face * nodes_per_face + j])] = 1.;
          array += roles[r].on_nodes;
        }
      }
    }
  } // namespace

  void write_surfaces(const std::string             &path,
                      const Parameters              &parameters,
                      const Bodies                  &bodies,
                      const dealii::DoFHandler<dim> &dof_handler,
                      const dealii::Mapping<dim>    &mapping,
                      const RigidMasters            &rigid)
  {
    namespace MPI                     = dealii::Utilities::MPI;
    const MPI_Comm     communicator   = communicator_of(dof_handler);
    const unsigned int degree         = dof_handler.get_fe().degree;
    const unsigned int nodes_per_face = (degree + 1) * (degree + 1);
    const auto         roles          = roles_of(parameters, bodies);
    const Faces        own            = owned_faces(roles, bodies, dof_handler, mapping, rigid);

    const auto  nodes = MPI::gather(communicator, own.nodes);
    const auto  X = MPI::gather(communicator, own.X), numbers = MPI::gather(communicator, own.numbers);
    const auto  of_faces = MPI::gather(communicator, own.roles), of_nodes = MPI::gather(communicator, own.node_roles);
    std::string problem;
    if (MPI::this_mpi_process(communicator) == 0)
    {
      VtuGrid                                    grid = empty_grid(roles, degree);
      std::unordered_map<DoFIndex, std::int32_t> point_of;
      for (unsigned int rank = 0; rank < nodes.size(); ++rank)
        add({nodes[rank], X[rank], numbers[rank], of_faces[rank], of_nodes[rank]},
            roles,
            nodes_per_face,
            point_of,
            grid);
      const std::filesystem::path whole(path);
      CompleteFile                file(whole.parent_path().string(), whole.filename().string());
      grid.write(file.stream());
      problem = file.finish();
    }
    throw_everywhere<InputError>(problem, communicator);
  }
} // namespace Nodus
