#ifndef nodus_parameters_parameter_checks_h
#define nodus_parameters_parameter_checks_h

#include "parameters/parameter_file.h"
#include <nodus/parameters/parameters.h>

#include <string>
#include <utility>

// What the files that check the values of a .prm file share.

namespace Nodus
{
  namespace ParameterChecks
  {
    /// A key and whether it has a value of its own.
    using Given = std::pair<const char *, bool>;

    /// A subsection under inspection.
    struct Section
    {
      const ParameterFile &file;
      std::string          name;

      void require(const bool satisfied, const std::string &key, const std::string &message) const
      {
        if (!satisfied)
          file.refuse(name, key, message);
      }
    };

    /// @p variables: "x,y,z", and perhaps one or two more, or "t" alone.
    void check_expression(const Section     &section,
                          const std::string &key,
                          const std::string &text,
                          const std::string &variables);

    void check(const Section          &section,
               const RegionParameters &region,
               const std::string      &prefix,
               unsigned int            n_bodies,
               unsigned int            smallest_body);

    /// @p axis: about which the motion turns where it names none.
    void check(const Section                    &section,
               const PrescribedMotionParameters &motion,
               const std::string                &prefix,
               const Vector3                    &axis);
    bool is_given(const PrescribedMotionParameters &motion);

    /// @p what it is that acts; @p interval_ends: of the load path.
    void check(const Section             &section,
               const ActiveTime          &time,
               const std::string         &what,
               const std::vector<double> &interval_ends);

    /// What drives a rigid body has an effect on its free components, what moves it on the others. @p prefix of the
    /// keys.
    void check_free_motion(const Section                    &section,
                           const std::string                &prefix,
                           const PrescribedMotionParameters &motion,
                           const std::vector<unsigned int>  &free,
                           const std::vector<std::string>   &force,
                           const std::vector<std::string>   &moment);

    /// Different predicates may separate faces of one id; the mesh will tell.
    bool share_faces(const RegionParameters &a, const RegionParameters &b);

    void check(const Section &section, const MaterialParameters &material);
    /// Of a rigid body, which has none.
    void refuse_material(const Section &section, const MaterialParameters &material);
    /// @p degree of the displacement.
    void check(const Section &section, const ContactPairParameters &pair, unsigned int n_bodies, unsigned int degree);
    void check(const Section                     &section,
               const BoundaryConditionParameters &condition,
               unsigned int                       n_bodies,
               const std::vector<double>         &interval_ends);

    /// Of the law, where it is one's own.
    void initialize(const Section &section, const MaterialParameters &material);
  } // namespace ParameterChecks
} // namespace Nodus

#endif
