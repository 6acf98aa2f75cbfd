#include "contact/varied_faces.h"
#include "contact/face_rule.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Nodus
{
  VariedFaces::VariedFaces(const std::vector<ContactPairParameters> &pairs,
                           const ContactSurfaces                    &surfaces,
                           const ContactGeometry                    &geometry,
                           const AveragedJump                       &averaged,
                           const VariationSources                   &sources,
                           const std::vector<Wanted>                &wanted)
      : pairs_(pairs)
      , surfaces_(surfaces)
      , geometry_(geometry)
      , averaged_(averaged)
      , sources_(sources)
      , X_(surfaces.positions(std::vector<Vector3>(surfaces.nodes().size())))
      , of_site_(surfaces.n_owned_slave_nodes())
  {
    for (const AveragedJump::Face &face : averaged.faces())
      note(face, wanted);
    find_foreign(wanted);
  }

  void VariedFaces::done(const unsigned int site)
  {
    for (const unsigned int i : of_site_[site])
      if (--faces_[i].n_sites == 0)
        faces_[i].variation.reset();
  }

  const FaceVariation &VariedFaces::variation(Around &around) const
  {
    if (!around.variation)
    {
      const unsigned int p       = around.face->pair;
      const bool         current = pairs_[p].surface_measure == ContactPairParameters::SurfaceMeasure::current;
      around.variation           = std::make_unique<FaceVariation>(
          geometry_,
          sources_,
          *around.face,
          current ? geometry_.slave[p].positions() : X_,
          current,
          around.with_normals ? std::optional<ContactPairParameters::Normal>(pairs_[p].normal) : std::nullopt);
    }
    return *around.variation;
  }

  void VariedFaces::note(const AveragedJump::Face &face, const std::vector<Wanted> &wanted)
  {
    unsigned int n_sites = 0;
    bool         normals = false;
    for (const unsigned int k : surfaces_.slave_faces(face.pair)[face.face].slaves)
      if (k < of_site_.size() && wanted[k] != Wanted::nothing)
      {
        of_site_[k].push_back(faces_.size());
        normals = normals || wanted[k] == Wanted::row_and_normal;
        ++n_sites;
      }
    if (n_sites > 0)
      faces_.push_back({&face, n_sites, normals, nullptr});
  }

  void VariedFaces::find_foreign(const std::vector<Wanted> &wanted)
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(surfaces_.layout().communicator);
    for (unsigned int p = 0; p < surfaces_.n_pairs(); ++p)
      if (pairs_[p].scheme == ContactPairParameters::Scheme::averaged)
      {
        const auto rule = face_rule(pairs_[p], surfaces_.degree());
        for (unsigned int f = 0; f < surfaces_.slave_faces(p).size(); ++f)
        {
          const SurfaceFace &face = surfaces_.slave_faces(p)[f];
          if (face.owner == rank ||
              std::none_of(face.slaves.begin(),
                           face.slaves.end(),
                           [&](const unsigned int k) { return k < of_site_.size() && wanted[k] != Wanted::nothing; }))
            continue;
          auto foreign = std::make_unique<AveragedJump::Face>(AveragedJump::Face{p, f, {}, {}, {}});
          AveragedJump::find_points(pairs_[p], geometry_, rule, *foreign);
          if (foreign->points.empty())
            continue;
          foreign_.push_back(std::move(foreign));
          note(*foreign_.back(), wanted);
        }
      }
  }
} // namespace Nodus
