#ifndef nodus_mesh_bodies_h
#define nodus_mesh_bodies_h

#include <nodus/mesh/curved_geometry.h>
#include <nodus/parameters.h>
#include <nodus/types.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/distributed/tria.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace Nodus
{
  /// All bodies as disconnected parts of one distributed triangulation.
  ///
  /// A cell's material id is the (zero-based) index of its body; boundary ids are those of the mesh
  /// file or of the generator, so that (body, boundary id) names a piece of boundary. A rigid body without a mesh is
  /// one cell around the others, whose faces have no id.
  class Bodies
  {
  public:
    /// Reads or generates every body, transforms it and concatenates the coarse meshes without gluing.
    /// @throws InputError: missing file or one of third order, no hexahedra, inverted cells, unknown volume id or
    /// generator.
    Bodies(const std::vector<BodyParameters> &parameters, MPI_Comm communicator);

    /// Boundary id of faces that are no part of any boundary.
    static constexpr dealii::types::boundary_id no_boundary = dealii::numbers::internal_face_boundary_id - 1;

    using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

    const Triangulation &triangulation() const
    {
      return triangulation_;
    }
    /// To refine and coarsen it.
    Triangulation &triangulation()
    {
      return triangulation_;
    }
    /// Divides the cells anew among the ranks, with equal sums of their weights, now and whenever the mesh changes;
    /// before anything is built on them. Collective.
    void balance(const std::function<unsigned int(const Triangulation::cell_iterator &)> &weight);

    /// The reference geometry, of @p degree per cell: that of second-order files where a body comes from one, also
    /// after refinement, that of the generators' manifolds elsewhere. May outlive the bodies.
    std::unique_ptr<dealii::Mapping<dim>> make_mapping(unsigned int degree) const;

    unsigned int size() const
    {
      return names_.size();
    }
    /// Name of body @p index (zero-based), as given or "body <number>".
    const std::string &name(const unsigned int index) const
    {
      return names_[index];
    }
    bool has_mesh(const unsigned int index) const
    {
      return has_mesh_[index];
    }
    /// Boundary ids present on body @p index, the same set on every rank.
    const std::set<dealii::types::boundary_id> &boundary_ids(const unsigned int index) const
    {
      return boundary_ids_[index];
    }
    /// Axis-aligned box of body @p index in the reference configuration.
    const dealii::BoundingBox<dim> &bounding_box(const unsigned int index) const
    {
      return boxes_[index];
    }

  private:
    /// Generated bodies before their transformation. Some manifolds look points up in the mesh they were made for,
    /// so these outlive the triangulation that uses the manifolds.
    std::vector<std::unique_ptr<dealii::Triangulation<dim>>> generated_;
    Triangulation                                            triangulation_;
    std::shared_ptr<CurvedGeometry>                          curved_;
    std::vector<std::string>                                 names_;
    std::vector<bool>                                        has_mesh_;
    std::vector<std::set<dealii::types::boundary_id>>        boundary_ids_;
    std::vector<dealii::BoundingBox<dim>>                    boxes_;

    void create(const std::vector<BodyParameters> &parameters);
    void refine(const std::vector<BodyParameters> &parameters);
    void place_vertices();
    void collect_extents();
  };
} // namespace Nodus

#endif
