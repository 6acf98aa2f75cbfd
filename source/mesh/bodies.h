#ifndef nodus_mesh_bodies_h
#define nodus_mesh_bodies_h

#include "mesh/curved_geometry.h"
#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/manifold.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace Nodus
{
  struct CoarseMesh;

  /// All bodies as disconnected parts of one distributed triangulation.
  ///
  /// A cell's material id is the (zero-based) index of its body; boundary ids are those of the mesh
  /// file or of the generator, so that (body, boundary id) names a piece of boundary. A rigid body without a mesh is
  /// one cell around the others, whose faces have no id.
  ///
  /// A mesh from files that will not be refined is divided before it is built, and a rank holds its share and what
  /// touches that; p4est, for all others, has every rank hold all coarse cells.
  class Bodies
  {
  public:
    /// Reads or generates every body, transforms it and concatenates the coarse meshes without gluing.
    /// @throws InputError: missing file or one of third order, no hexahedra, inverted cells, unknown volume id or
    /// generator, a solution that would not fit into memory.
    /// @param may_be_refined after this @param slaves whose faces make their cells heavier when the mesh is divided
    /// @param degree of the elements, for the memory that the solution takes
    Bodies(const std::vector<BodyParameters>   &parameters,
           MPI_Comm                             communicator,
           bool                                 may_be_refined = true,
           const std::vector<RegionParameters> &slaves         = {},
           unsigned int                         degree         = 1);

    /// Boundary id of faces that are no part of any boundary.
    static constexpr dealii::types::boundary_id no_boundary = dealii::numbers::internal_face_boundary_id - 1;

    using Triangulation          = dealii::parallel::DistributedTriangulationBase<dim>;
    using RefinableTriangulation = dealii::parallel::distributed::Triangulation<dim>;

    const Triangulation &triangulation() const
    {
      return *triangulation_;
    }
    /// To refine and coarsen it; null when it cannot be.
    RefinableTriangulation *refinable()
    {
      return refinable_;
    }
    /// Number of the coarse ancestor of @p cell among all coarse cells, in the order of the files and generators.
    unsigned int coarse_cell(const Triangulation::cell_iterator &cell) const
    {
      return curved_->coarse_cell(cell);
    }

    /// Whether @p cell has the shape of a cell of second order in a mesh file.
    bool is_curved(const Triangulation::cell_iterator &cell) const
    {
      return curved_->covers(cell);
    }

    /// Work of a cell (assembly, solution with multigrid) and, on top, of a slave face (search, jumps, couplings). That
    /// is 0.1 against 1.5 ms of a Hertz case with 40824 cells and 576 slave faces; but ranks without contact sleep
    /// while they wait for such work, and poll in that of cells: a quarter of it gives the least CPU in the same time.
    static constexpr unsigned int cell_weight = 1000, slave_face_weight = 4000;
    /// Divides the cells anew among the ranks, with equal sums of their weights, now and whenever the mesh changes;
    /// before anything is built on them. One that cannot be refined has been divided already. Collective.
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
    const std::vector<std::string> &names() const
    {
      return names_;
    }
    /// How often the cells of body @p index have been split at the most before the run adapts the mesh.
    unsigned int level(const unsigned int index) const
    {
      return levels_[index];
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
    /// Names that the mesh file of body @p index has for its physical surfaces, by boundary id.
    const std::map<unsigned int, std::string> &boundary_names(const unsigned int index) const
    {
      return boundary_names_[index];
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
    std::shared_ptr<CurvedGeometry>                          curved_;
    std::unique_ptr<Triangulation>                           triangulation_;
    RefinableTriangulation                                  *refinable_ = nullptr; ///< the same, if it is of that kind
    std::vector<std::string>                                 names_;
    std::vector<unsigned int>                                levels_;
    std::vector<bool>                                        has_mesh_;
    std::vector<std::set<dealii::types::boundary_id>>        boundary_ids_;
    std::vector<std::map<unsigned int, std::string>>         boundary_names_;
    std::vector<dealii::BoundingBox<dim>>                    boxes_;

    using Manifolds = std::map<dealii::types::manifold_id, std::unique_ptr<dealii::Manifold<dim>>>;

    CoarseMesh read(const std::vector<BodyParameters> &parameters,
                    unsigned int                       degree,
                    Manifolds                         &manifolds,
                    MPI_Comm                           communicator);
    void       make_share(const CoarseMesh &mesh, const std::vector<RegionParameters> &slaves, MPI_Comm communicator);
    void       make_refinable(const CoarseMesh &mesh, const Manifolds &manifolds, MPI_Comm communicator);
    void       refine(const std::vector<BodyParameters> &parameters, unsigned int degree);
    void       place_vertices();
    void       collect_extents();
  };
} // namespace Nodus

#endif
