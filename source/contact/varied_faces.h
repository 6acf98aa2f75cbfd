#ifndef nodus_contact_varied_faces_h
#define nodus_contact_varied_faces_h

#include "contact/face_variation.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// The slave faces of the averaged scheme around the sites at hand, with their variations: each is made when the
  /// first site asks, and dropped after the last one.
  class VariedFaces
  {
  public:
    /// Of a site.
    enum class Wanted : char
    {
      nothing,
      row,
      row_and_normal ///< the mean over the faces
    };
    /// @p wanted: per site.
    VariedFaces(const std::vector<ContactPairParameters> &pairs,
                const ContactSurfaces                    &surfaces,
                const ContactGeometry                    &geometry,
                const AveragedJump                       &averaged,
                const VariationSources                   &sources,
                const std::vector<Wanted>                &wanted);

    /// Calls f(variation, number of a slave node of the face, part of it) for what the faces around a site add to its
    /// row.
    template <typename Function>
    void for_each(const unsigned int site, const Function &f)
    {
      for (const unsigned int i : of_site_[site])
      {
        const FaceVariation &varied = variation(faces_[i]);
        const auto          &slaves = surfaces_.slave_faces(faces_[i].face->pair)[faces_[i].face->face].slaves;
        averaged_.for_each_part(slaves, site, [&](const unsigned int a, const double part) { f(varied, a, part); });
      }
    }
    /// An active site will not ask again.
    void done(unsigned int site);

  private:
    struct Around
    {
      const AveragedJump::Face      *face;
      unsigned int                   n_sites; ///< that are not done
      bool                           with_normals;
      std::unique_ptr<FaceVariation> variation;
    };

    const FaceVariation &variation(Around &around) const;
    void                 note(const AveragedJump::Face &face, const std::vector<Wanted> &wanted);
    /// Faces of other ranks at sites of this one: their masters are here, too.
    void find_foreign(const std::vector<Wanted> &wanted);

    const std::vector<ContactPairParameters>        &pairs_;
    const ContactSurfaces                           &surfaces_;
    const ContactGeometry                           &geometry_;
    const AveragedJump                              &averaged_;
    const VariationSources                          &sources_;
    std::vector<Point>                               X_; ///< reference positions
    std::vector<std::vector<unsigned int>>           of_site_;
    std::vector<Around>                              faces_;
    std::vector<std::unique_ptr<AveragedJump::Face>> foreign_;
  };
} // namespace Nodus

#endif
