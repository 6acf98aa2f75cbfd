#ifndef nodus_mesh_region_h
#define nodus_mesh_region_h

#include "mesh/bodies.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>

#include <memory>

namespace dealii
{
  template <int>
  class FunctionParser;
}

namespace Nodus
{
  /// A part of the boundary of some or all bodies: faces by boundary id, or all of them, thinned by a predicate of the
  /// reference coordinates (evaluated at the nodes for nodal conditions, at face centres for the others) and of the
  /// normal at the centre of the face. Or cells, by body and predicate.
  class Region
  {
  public:
    /// @p context names the subsection in messages, e.g. "Contact pair 1, slave".
    /// @throws InputError, on every rank, on an unknown body, an id no face of the bodies has, a body without any of
    /// the ids, or a predicate that does not parse, or is not a number at a vertex or the centre of a face (or
    /// cell) that it thins out. @p of_cells: cells are meant, not faces. Collective.
    Region(const RegionParameters &parameters, const Bodies &bodies, const std::string &context, bool of_cells = false);
    ~Region();
    Region(Region &&) noexcept;

    /// True when @p face of @p cell is at the boundary, of the region's body and has one of its ids.
    template <typename Cell>
    bool contains_face(const Cell &cell, const unsigned int face) const
    {
      return cell->face(face)->at_boundary() && cell->face(face)->boundary_id() != Bodies::no_boundary &&
             parameters_.takes(cell->material_id() + 1, cell->face(face)->boundary_id());
    }

    /// True when the body of the cell belongs to the region (body forces).
    template <typename Cell>
    bool contains_cell(const Cell &cell) const
    {
      return parameters_.has_body(cell->material_id() + 1);
    }

    /// contains_face, and the predicate holds at the centre of the face as @p mapping bends it.
    template <typename Cell>
    bool selects_face(const dealii::Mapping<dim> &mapping, const Cell &cell, const unsigned int face) const
    {
      if (!predicate_ || !contains_face(cell, face))
        return contains_face(cell, face);
      return contains_point(mapping.transform_unit_to_real_cell(cell, on_unit_face(face, 0.5, 0.5)),
                            normal(mapping, cell, face));
    }

    /// contains_cell, and the predicate holds at the centre of the cell as @p mapping bends it.
    template <typename Cell>
    bool selects_cell(const dealii::Mapping<dim> &mapping, const Cell &cell) const
    {
      return contains_cell(cell) &&
             (!predicate_ || contains_point(mapping.transform_unit_to_real_cell(cell, Point(0.5, 0.5, 0.5))));
    }

    /// The outward unit normal at the centre of the face as @p mapping bends it (up to the second degree), without
    /// round-off; zero where the predicate does not ask for it.
    template <typename Cell>
    Vector3 normal(const dealii::Mapping<dim> &mapping, const Cell &cell, const unsigned int face) const
    {
      if (!asks_for_normal_)
        return {};
      const auto at = [&](const double a, const double b)
      { return mapping.transform_unit_to_real_cell(cell, on_unit_face(face, a, b)); };
      return outward_normal(face, at(1., 0.5) - at(0., 0.5), at(0.5, 1.) - at(0.5, 0.));
    }

    /// The predicate at a reference point of a face with this normal(); true where there is none.
    bool contains_point(const Point &X, const Vector3 &normal = Vector3()) const;

  private:
    /// The point at @p a, @p b of the two directions after that of the normal of a face.
    static Point on_unit_face(const unsigned int face, const double a, const double b)
    {
      Point unit;
      unit[face / 2]             = face % 2;
      unit[(face / 2 + 1) % dim] = a;
      unit[(face / 2 + 2) % dim] = b;
      return unit;
    }
    /// @p a and @p b: chords between the middles of opposite edges of the face.
    static Vector3 outward_normal(unsigned int face, const Vector3 &a, const Vector3 &b);

    void refuse_absent(const Bodies &bodies, const std::string &context) const;
    void refuse_undefined(const Bodies &bodies, const std::string &context, bool of_cells) const;

    double value_at(const Point &X, const Vector3 &normal) const;

    RegionParameters parameters_;
    bool             asks_for_normal_ = false;
    /// Parsed anew for each normal, which are constants of it: deal.II knows four variables.
    mutable std::unique_ptr<dealii::FunctionParser<dim>> predicate_;
    mutable Vector3                                      normal_of_predicate_;
  };
} // namespace Nodus

#endif
