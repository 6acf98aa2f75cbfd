#ifndef nodus_bulk_follower_pressure_h
#define nodus_bulk_follower_pressure_h

#include "bulk/face_table.h"

#include <deal.II/fe/fe.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <vector>

namespace Nodus
{
  /// Quadrature point of a loaded face.
  struct LoadedPoint
  {
    Point   X;
    Vector3 tangent[2]; ///< dX/d(unit coordinate), their cross product points out of the body
    double  weight;     ///< on the unit face
    double  area;       ///< weight times reference area
  };

  /// Pressure on the deformed face of a cell (eq. B3): f_a = - int p N_a (t_0 x t_1) with the current tangents t. Its
  /// derivative is int p N_a v_b x du_b, v_b = N_b,0 t_1 - N_b,1 t_0.
  class FollowerPressure
  {
  public:
    /// @p pressure: at each of the @p points, which are those of the @p table. All arguments outlive the object.
    FollowerPressure(const dealii::FiniteElement<dim> &fe,
                     const FaceTable                  &table,
                     const std::vector<LoadedPoint>   &points,
                     const std::vector<double>        &pressure);

    /// Adds the forces at the displacement @p u of the cell to @p external and, unless it is null, the symmetric half
    /// of the derivative of -f to @p tangent; in the order of the element's degrees of freedom.
    void add(const std::vector<double> &u, dealii::Vector<double> &external, dealii::FullMatrix<double> *tangent) const;
    /// Adds the other half, which is an integral along the edge of the face.
    void add_unsymmetric(const std::vector<double> &u, dealii::FullMatrix<double> &tangent) const;

  private:
    struct Tangents
    {
      Vector3 t[2];
    };
    Tangents     tangents(unsigned int q, const std::vector<double> &u) const;
    void         add_half(unsigned int q, const Tangents &now, double sign, dealii::FullMatrix<double> &tangent) const;
    unsigned int dof(const unsigned int node, const unsigned int component) const
    {
      return fe_.component_to_system_index(component, table_.nodes[node]);
    }

    const dealii::FiniteElement<dim> &fe_;
    const FaceTable                  &table_;
    const std::vector<LoadedPoint>   &points_;
    const std::vector<double>        &pressure_;
  };
} // namespace Nodus

#endif
