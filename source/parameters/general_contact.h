#ifndef nodus_parameters_general_contact_h
#define nodus_parameters_general_contact_h

#include <string>
#include <vector>

// Contact pairs that touch themselves ("Self contact"): which bodies and faces they have, and which do not meet there.

namespace dealii
{
  class ParameterHandler;
}

namespace Nodus
{
  class ParameterFile;
  struct BodyParameters;
  struct ContactPairParameters;
  struct RegionParameters;

  /// The key "Excluded bodies": a list of two numbers or names of bodies with a colon between them.
  void add_excluded_bodies(dealii::ParameterHandler &prm, ContactPairParameters &pair);

  /// Replaces what is not given by all bodies that have a mesh, rigid ones among them, and by all outer faces.
  void complete_general_contact(RegionParameters &region, const std::vector<BodyParameters> &bodies);

  /// Takes the slave side for the master side, too, and the rigid bodies, which cannot be slave, from the slave side.
  void make_both_sides(ContactPairParameters &pair, const std::vector<BodyParameters> &bodies);

  /// What is master alone in a pair that touches itself, its rigid bodies; of no body where there are none.
  RegionParameters master_alone(const ContactPairParameters &pair);

  /// Replaces the names of excluded bodies by their numbers. @p section: of the pair.
  /// @throws InputError, by ParameterFile::refuse(), for what is no two bodies of the pair.
  void resolve_excluded_bodies(ContactPairParameters             &pair,
                               const std::vector<BodyParameters> &bodies,
                               const ParameterFile               &file,
                               const std::string                 &section);
} // namespace Nodus

#endif
