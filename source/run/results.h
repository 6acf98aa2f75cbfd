#ifndef nodus_run_results_h
#define nodus_run_results_h

#include "output/body_points.h"
#include "output/vtu.h"
#include "run/equilibrium.h"
#include <nodus/contact/contact_fields.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Nodus
{
  /// What the user gets of every converged increment: fields, resultants, reactions, motions, and their files.
  class Results
  {
  public:
    /// All outlive it.
    Results(const Model &model, Journal &journal, const States &states, const Equilibrium &equilibrium);

    /// Finds the points whose values are written in the cells of the mesh as it is. Collective. @throws InputError
    void find_points();
    /// What is written on the mesh as it is. Collective. @throws InputError
    void begin_on_mesh();
    /// What the run starts from, as increment 0.
    void write_initial_state();
    /// The increment has just been committed. Collective.
    void update();
    /// Adds it to tables and files, @p last of the run.
    void write(const Increment &increment, bool last);
    /// The committed state, of the @p increment of this number that ended at @p time.
    void write_state(unsigned int increment, double time);

    const std::vector<ContactFields>                   &whole_fields(); ///< of all ranks. Collective.
    const std::vector<ContactResultants>               &resultants() const;
    const std::vector<std::pair<std::string, Vector3>> &reactions() const;
    const std::vector<RigidBodyMotion>                 &rigid_motions() const;
    const std::vector<PreloadSection>                  &preloads() const;
    /// Of the node of body @p body (number, from 1) at @p X. Collective. @throws InputError without one.
    Vector3 displacement(unsigned int body, const Point &X) const;

    VtuOutput *vtu() ///< null where none is asked for
    {
      return vtu_.get();
    }

  private:
    void add_points(const Increment &increment, bool with_lines);

    const Model                                 &model_;
    Journal                                     &journal_;
    const States                                &states_;
    const Equilibrium                           &equilibrium_;
    std::vector<ContactFields>                   fields_;       ///< of this rank's part of the surfaces
    std::vector<ContactFields>                   whole_fields_; ///< of all ranks, once somebody asked for them
    std::vector<ContactResultants>               resultants_;
    std::vector<std::pair<std::string, Vector3>> reactions_;
    std::vector<RigidBodyMotion>                 rigid_motions_;
    std::vector<PreloadSection>                  preloads_;
    std::unique_ptr<VtuOutput>                   vtu_;
    std::unique_ptr<BodyPoints>                  points_; ///< of all points, then of all lines; null without any
  };
} // namespace Nodus

#endif
