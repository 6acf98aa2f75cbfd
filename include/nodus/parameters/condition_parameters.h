#ifndef nodus_parameters_condition_parameters_h
#define nodus_parameters_condition_parameters_h

#include <nodus/base/types.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

// Where, when and what is prescribed. Boundary conditions are a subsection of the parameter file, as in parameters.h;
// the other structs are parts of subsections.

namespace Nodus
{
  /// A part of the boundary: faces of some bodies (or of all) with the given boundary ids.
  struct RegionParameters
  {
    std::vector<unsigned int>               bodies;       ///< by number; empty = every body
    std::vector<dealii::types::boundary_id> boundary_ids; ///< of all these bodies
    std::string                             where; ///< muParser predicate of x, y, z, nx, ny, nz; empty = everywhere
    std::vector<std::string>                body_names = {}; ///< which Parameters::read() replaces by numbers
    /// Names of physical surfaces, which Parameters::read() replaces by their ids, unless several bodies are meant ...
    std::vector<std::string> boundary_names = {};
    /// ... of which each, by its number, may have other ids for the same names, or has ids of its own ("2:5").
    std::map<unsigned int, std::vector<dealii::types::boundary_id>> ids_of_body = {};

    /// Whether the body of this number belongs to it.
    bool has_body(unsigned int number) const;
    /// The number of the only body or the first one; 0: every body.
    unsigned int first_body() const
    {
      return bodies.empty() ? 0 : bodies.front();
    }
    /// Whether faces of a body (by number) with the boundary id @p id belong to it, but for where.
    bool takes(unsigned int of_body, dealii::types::boundary_id id) const;
    /// Whether ids or names are given at all.
    bool has_ids() const
    {
      return !boundary_ids.empty() || !boundary_names.empty() || !ids_of_body.empty();
    }
    /// Whether it says which faces it has: without ids all of the bodies where the predicate holds.
    bool chooses_faces() const
    {
      return has_ids() || !where.empty();
    }
    /// "2, 3", or "0" for every body, as the keys have it.
    std::string body_numbers() const;
    /// "body 2", "bodies 2, 3" or "any body", for messages.
    std::string bodies_text() const;
    /// "1, 5", with the names of a region of several bodies behind the ids, then what single bodies have.
    std::string ids_text() const;
  };

  /// A rigid body in time: x = c + R(t) (X - c) + T(t).
  struct PrescribedMotionParameters
  {
    std::vector<std::string> translation = {"0", "0", "0"}; ///< T, muParser expressions of t [length]
    std::string              rotation    = "0";             ///< angle about the axis, expression of t [degrees]
    Vector3                  rotation_axis;                 ///< zero: what the owner says
    std::vector<double>      rotation_centre;               ///< c, reference position; empty: what the owner says
  };

  /// When a boundary condition or a contact pair acts.
  struct ActiveTime
  {
    double active_from  = 0.; ///< in the increments after this time ...
    double active_until = 0.; ///< ... that end at this time at the latest; 0 = the whole path

    /// Whether it counts for the equilibrium at time @p t, and for those right after it.
    bool acts(const double t) const
    {
      return (active_from == 0. || t > active_from) && (active_until == 0. || t <= active_until);
    }
    bool acts_after(const double t) const
    {
      return t >= active_from && (active_until == 0. || t < active_until);
    }
  };

  struct BoundaryConditionParameters : ActiveTime
  {
    enum class Type
    {
      displacement,
      rigid_motion, ///< displacement of points that move as one rigid body
      traction,     ///< dead, per reference area
      pressure,     ///< follower, per current area, positive pushes on the body
      body_force,   ///< dead, per reference volume; the region's body only
      spring,       ///< to ground, stiffness per reference area
      point_load,   ///< dead force at a point of a body
      point_spring  ///< to ground, stiffness at a point of a body
    };
    std::string               name;
    Type                      type = Type::displacement;
    RegionParameters          region;
    std::vector<double>       point;      ///< of types point_load and point_spring: reference position; else empty
    std::vector<unsigned int> components; ///< 0, 1, 2; not used by pressure
    std::vector<double>       direction;  ///< of loads and springs along any axis, instead of components; else empty
    /// muParser expressions of x, y, z, t and the value of the table: one per component, one for pressure or direction.
    std::vector<std::string>   value;
    std::vector<double>        table_times;  ///< of the table, increasing [time] ...
    std::vector<double>        table_values; ///< ... and its values, linear between them [as type says]
    std::string                table_file;   ///< that has them; Parameters::read() replaces it by these
    PrescribedMotionParameters motion;       ///< of type rigid_motion; keys "Translation", "Rotation", ...
    std::vector<unsigned int>  free; ///< components of a rigid motion that force and moment drive, as of rigid bodies
    std::vector<std::string>   force  = {"0", "0", "0"}; ///< muParser expressions of t [force]
    std::vector<std::string>   moment = {"0", "0", "0"}; ///< about the rotation centre as it moves [force length]
    /// What a program sets instead of the expressions, called with reference position, time and place in value, which
    /// keeps its length. It may follow what the program sees after an increment: what it gives changes from increment
    /// to increment alone, and is the same on every rank.
    std::function<double(const Point &, double, unsigned int)> function;

    /// Whether it prescribes displacements.
    bool holds() const
    {
      return type == Type::displacement || type == Type::rigid_motion;
    }
    /// Whether it acts at one point of a body.
    bool at_point() const
    {
      return type == Type::point_load || type == Type::point_spring;
    }
    /// Unit vectors along what the entries of value act, none of a pressure.
    std::vector<Vector3> directions() const
    {
      std::vector<Vector3> all(components.size());
      for (unsigned int e = 0; e < components.size(); ++e)
        all[e][components[e]] = 1.;
      if (direction.size() == dim)
      {
        const Vector3 along({direction[0], direction[1], direction[2]});
        all.push_back(along / along.norm());
      }
      return all;
    }
    /// How many entries value has.
    unsigned int n_values() const
    {
      return type == Type::pressure || !direction.empty() ? 1 : components.size();
    }
    /// Whether it couples its nodes to a rigid motion that equilibrium finds.
    bool couples() const
    {
      return type == Type::rigid_motion && !free.empty();
    }
  };
} // namespace Nodus

#endif
