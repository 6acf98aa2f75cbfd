#include "mesh/bodies.h"
#include "mesh/gmsh_reader.h"
#include "mesh/memory.h"
#include "mesh/mesh_share.h"
#include "parameters/expression.h"
#include "parameters/generators.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>
#include <deal.II/physics/transformations.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <regex>
#include <sstream>
#include <tuple>

// The cells of all bodies, from files and generators.

namespace Nodus
{
  namespace
  {
    /// x -> scale * rotation * x + translation.
    struct Placement
    {
      explicit Placement(const BodyParameters &parameters)
          : scale(parameters.scale)
          , rotation(dealii::unit_symmetric_tensor<dim>())
          , translation(parameters.translation)
      {
        if (!(scale > 0.))
          throw InputError("'Scale' must be positive");
        if (parameters.rotation_angle == 0.)
          return;
        const double length = parameters.rotation_axis.norm();
        if (length == 0.)
          throw InputError("'Rotation axis' is zero; give a direction, for example 0, 0, 1");
        rotation = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
            Point(parameters.rotation_axis / length), parameters.rotation_angle * dealii::numbers::PI / 180.);
      }

      Point apply(const Point &x) const
      {
        return Point(scale * (rotation * x) + translation);
      }
      Point undo(const Point &x) const
      {
        return Point(dealii::transpose(rotation) * (x - translation) / scale);
      }

      double                 scale;
      dealii::Tensor<2, dim> rotation;
      Vector3                translation;
    };

    /// A manifold of a generated body, seen through the placement of that body. Refining the placed mesh then gives
    /// the same points as placing the refined mesh, whatever the kind of manifold.
    class PlacedManifold : public dealii::Manifold<dim>
    {
    public:
      PlacedManifold(const dealii::Manifold<dim> &original, const Placement &placement)
          : original_(original.clone())
          , placement_(placement)
      {
      }

      std::unique_ptr<dealii::Manifold<dim>> clone() const override
      {
        return std::make_unique<PlacedManifold>(*original_, placement_);
      }

      Point get_new_point(const dealii::ArrayView<const Point>  &around,
                          const dealii::ArrayView<const double> &weights) const override
      {
        const std::vector<Point> before = undo(around);
        return placement_.apply(original_->get_new_point(dealii::make_array_view(before), weights));
      }

      void get_new_points(const dealii::ArrayView<const Point> &around,
                          const dealii::Table<2, double>       &weights,
                          dealii::ArrayView<Point>              new_points) const override
      {
        const std::vector<Point> before = undo(around);
        original_->get_new_points(dealii::make_array_view(before), weights, new_points);
        for (Point &p : new_points)
          p = placement_.apply(p);
      }

      Vector3 get_tangent_vector(const Point &x1, const Point &x2) const override
      {
        return placement_.scale *
               (placement_.rotation * original_->get_tangent_vector(placement_.undo(x1), placement_.undo(x2)));
      }

    private:
      std::vector<Point> undo(const dealii::ArrayView<const Point> &points) const
      {
        std::vector<Point> result;
        result.reserve(points.size());
        for (const Point &p : points)
          result.push_back(placement_.undo(p));
        return result;
      }

      std::unique_ptr<dealii::Manifold<dim>> original_;
      Placement                              placement_;
    };

    std::unique_ptr<dealii::Triangulation<dim>> generate(const BodyParameters &parameters)
    {
      auto              mesh = std::make_unique<dealii::Triangulation<dim>>();
      const std::string call =
          "'Generator' = " + parameters.generator + ", 'Generator arguments' = " + parameters.generator_arguments;
      try
      {
        dealii::GridGenerator::generate_from_name_and_arguments(
            *mesh,
            parameters.generator,
            Generators::arguments_for_deal_ii(parameters.generator, parameters.generator_arguments));
      }
      catch (const dealii::ExceptionBase &error)
      {
        std::ostringstream reason;
        error.print_info(reason);
        std::string text = reason.str();
        std::smatch tuple; // deal.II answers wrong arguments with its pattern for them
        if (std::regex_search(text, tuple, std::regex("Tuple of <(\\d+)> elements")))
          throw InputError(call + " failed; this generator takes " + tuple[1].str() +
                           " arguments separated by ':', all those of deal.II's function but the mesh, e.g. "
                           "subdivided_hyper_rectangle 3,3,2 : 0,0,0 : 1,1,1 : true");
        throw InputError(call +
                         " failed; use the name and the arguments, separated by ':', of a function of "
                         "deal.II's GridGenerator for three dimensions. deal.II says: " +
                         text);
      }
      catch (const std::bad_alloc &)
      {
        throw InputError(call + " makes a mesh that does not fit into memory; ask for fewer cells");
      }
      if (!mesh->all_reference_cells_are_hyper_cube())
        throw InputError(call + " makes cells that are no hexahedra; use another generator");
      if (mesh->n_levels() != 1)
        throw InputError(call + " makes a refined mesh; use 'Global refinement' instead");
      return mesh;
    }

    /// Determinant of the trilinear map at a corner, divided by the lengths of the three edges there: 1 for a cube.
    double scaled_jacobian(const std::vector<Point> &vertices, const dealii::CellData<dim> &cell, const unsigned int v)
    {
      dealii::Tensor<2, dim> edges;
      for (unsigned int d = 0; d < dim; ++d)
      {
        const unsigned int high = v | (1u << d), low = v & ~(1u << d);
        edges[d]            = vertices[cell.vertices[high]] - vertices[cell.vertices[low]];
        const double length = edges[d].norm();
        if (length == 0.)
          return 0.;
        edges[d] /= length;
      }
      return dealii::determinant(edges);
    }

    /// @p origin names the file or generator. The corners alone are the geometry of linear elements, so they count also
    /// where the cell is curved.
    void check_orientation(const CoarseMesh &mesh, const std::string &origin)
    {
      const auto refuse = [&](const Point &centre, const std::string &what, const std::string &fix)
      {
        std::ostringstream text;
        text << origin << ": the cell with centre (" << centre << ") is turned inside out or collapsed " << what << "; "
             << fix;
        throw InputError(text.str());
      };
      for (const auto &cell : mesh.cells)
        for (const unsigned int v : dealii::GeometryInfo<dim>::vertex_indices())
          if (!(scaled_jacobian(mesh.vertices, cell, v) > 1e-6))
          {
            Point centre;
            for (const auto i : cell.vertices)
              centre += mesh.vertices[i] / 8.;
            refuse(centre, "at a corner", "every hexahedron needs eight convex corners: mesh this place anew");
          }
      for (const auto &cell : mesh.curved)
        if (!(cell.smallest_scaled_jacobian() > 1e-6))
          refuse(cell.nodes[13],
                 "by its curved edges or faces",
                 "mesh this place finer, or let gmsh untangle it with Mesh.HighOrderOptimize=2");
    }

    /// Adds @p body to @p all without gluing anything.
    void append(const CoarseMesh &body, const dealii::types::material_id material_id, CoarseMesh &all)
    {
      const auto offset = all.vertices.size();
      const auto take   = [offset](const auto &from, auto &to, const auto &change)
      {
        for (auto cell : from)
        {
          for (auto &v : cell.vertices)
            v += offset;
          change(cell);
          to.push_back(cell);
        }
      };
      const auto keep = [](auto &) {};
      all.vertices.insert(all.vertices.end(), body.vertices.begin(), body.vertices.end());
      take(body.cells, all.cells, [material_id](auto &cell) { cell.material_id = material_id; });
      take(body.boundary.boundary_lines, all.boundary.boundary_lines, keep);
      take(body.boundary.boundary_quads, all.boundary.boundary_quads, keep);
    }

    /// Gives the manifolds of a generated body ids that no other body uses, in @p mesh and in @p manifolds.
    void place_manifolds(const dealii::Triangulation<dim>                                             &generated,
                         const Placement                                                              &placement,
                         CoarseMesh                                                                   &mesh,
                         std::map<dealii::types::manifold_id, std::unique_ptr<dealii::Manifold<dim>>> &manifolds)
    {
      std::map<dealii::types::manifold_id, dealii::types::manifold_id> renumbered;
      for (const auto id : generated.get_manifold_ids())
        if (id != dealii::numbers::flat_manifold_id)
        {
          const dealii::types::manifold_id number = manifolds.size();
          manifolds[number] = std::make_unique<PlacedManifold>(generated.get_manifold(id), placement);
          renumbered[id]    = number;
        }
      const auto renumber = [&](auto &cells)
      {
        for (auto &cell : cells)
          if (cell.manifold_id != dealii::numbers::flat_manifold_id)
            cell.manifold_id = renumbered.at(cell.manifold_id);
      };
      renumber(mesh.cells);
      renumber(mesh.boundary.boundary_lines);
      renumber(mesh.boundary.boundary_quads);
    }

    /// What stands for a rigid body without a mesh: one cell around the vertices of the others.
    CoarseMesh cell_around(const std::vector<Point> &vertices)
    {
      const dealii::BoundingBox<dim> box(vertices);
      CoarseMesh                     mesh;
      mesh.cells.resize(1);
      for (const unsigned int v : dealii::GeometryInfo<dim>::vertex_indices())
      {
        mesh.vertices.push_back(box.vertex(v));
        mesh.cells[0].vertices[v] = v;
      }
      for (const unsigned int f : dealii::GeometryInfo<dim>::face_indices())
      {
        mesh.boundary.boundary_quads.emplace_back();
        for (unsigned int v = 0; v < 4; ++v)
          mesh.boundary.boundary_quads[f].vertices[v] = dealii::GeometryInfo<dim>::face_to_cell_vertices(f, v);
        mesh.boundary.boundary_quads[f].boundary_id = Bodies::no_boundary;
      }
      return mesh;
    }

    std::string display_name(const BodyParameters &parameters, const unsigned int index)
    {
      return parameters.name.empty() ? "body " + std::to_string(index + 1) : parameters.name;
    }
  } // namespace

  CoarseMesh Bodies::read(const std::vector<BodyParameters> &parameters,
                          const unsigned int                 degree,
                          Manifolds                         &manifolds,
                          const MPI_Comm                     communicator)
  {
    if (parameters.empty())
      throw InputError("There is no body; add a subsection 'Body 1'");

    CoarseMesh                      all;
    std::map<std::string, GmshFile> files;
    for (unsigned int b = 0; b < parameters.size(); ++b)
      try
      {
        const BodyParameters &body = parameters[b];
        names_.push_back(display_name(body, b));
        levels_.push_back(body.global_refinement + body.local_refinement);
        boundary_names_.emplace_back();
        has_mesh_.push_back(body.has_mesh() || !body.rigid);
        if (!has_mesh_[b])
          continue;
        if (body.mesh_file.empty() == body.generator.empty())
          throw InputError("give either 'Mesh file' or 'Generator'");

        const Placement placement(body);
        CoarseMesh      mesh;
        const auto      check_size = [&](const double n_coarse_cells)
        { refuse_beyond_memory(n_coarse_cells * std::pow(8., body.global_refinement), degree, communicator); };
        if (!body.mesh_file.empty())
        {
          mesh = from_first_rank(
              [&] { return files.try_emplace(body.mesh_file, body.mesh_file).first->second.body(body.volume_ids); },
              communicator);
          boundary_names_[b] = mesh.boundary_names;
        }
        else
        {
          check_size(Generators::n_cells(body.generator, body.generator_arguments));
          generated_.push_back(generate(body));
          std::tie(mesh.vertices, mesh.cells, mesh.boundary) =
              dealii::GridTools::get_coarse_mesh_description(*generated_.back());
          place_manifolds(*generated_.back(), placement, mesh, manifolds);
        }
        check_size(mesh.cells.size());
        check_orientation(mesh, body.mesh_file.empty() ? "generator " + body.generator : "mesh file " + body.mesh_file);
        for (Point &vertex : mesh.vertices)
          vertex = placement.apply(vertex);
        for (unsigned int c = 0; c < mesh.curved.size(); ++c)
        {
          for (Point &node : mesh.curved[c].nodes)
            node = placement.apply(node);
          curved_->add(all.cells.size() + c, mesh.curved[c]);
        }
        append(mesh, b, all);
      }
      catch (const InputError &error)
      {
        throw InputError("Body " + std::to_string(b + 1) +
                         (parameters[b].name.empty() ? "" : " (" + parameters[b].name + ")") + ": " + error.what());
      }

    const CoarseMesh around = cell_around(all.vertices);
    for (unsigned int b = 0; b < parameters.size(); ++b)
      if (!has_mesh_[b])
        append(around, b, all);

    return all;
  }
} // namespace Nodus
