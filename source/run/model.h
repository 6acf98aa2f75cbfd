#ifndef nodus_run_model_h
#define nodus_run_model_h

#include "bulk/boundary_conditions.h"
#include "bulk/material.h"
#include "bulk/solid_assembler.h"
#include "bulk/viscous_stabilisation.h"
#include "contact/contact_interface.h"
#include "mesh/bodies.h"
#include "rigid/rigid_bodies.h"
#include "run/load_stepping.h"
#include "run/state.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping.h>

#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// What is computed: bodies, mesh, degrees of freedom, materials, conditions and contact, without any algorithm.
  struct Model
  {
    /// @p states outlive it; they are set to those at rest. @p parameters have room for a second pass of each contact
    /// pair (with_room()). Collective. @throws InputError
    Model(Parameters &parameters, MPI_Comm communicator, States &states);
    /// What refers to a pair stays valid where second passes are added.
    static Parameters with_room(Parameters parameters);

    /// @throws InputError on every rank where nodes of coupled faces are part of contact surfaces.
    void refuse_coupled_contact() const;
    /// @throws InputError on every rank where the slave side of a bolt's section has nodes of other contact surfaces.
    void refuse_shared_sections() const;
    /// All that is made for the mesh as it is. The state at hand is at rest then, but for what does not depend on the
    /// mesh: rigid bodies, energies.
    void set_up_mesh(State &now);
    /// Prescribed displacements, loads and rigid motions at time @p t. Collective. @throws InputError, on every rank,
    /// where one is not a number.
    void set_conditions(double t);
    /// Conditions and motions of rigid surfaces at @p times to come, so that what is not a number there is refused
    /// before the run has come so far; those of the first of them hold afterwards. Collective. @throws InputError
    void look_ahead(const std::vector<double> &times);
    /// Contact pairs that begin or cease to act at time @p t do so (ContactInterface::begin), in the states that an
    /// increment from there begins with; what held the latter is released like a reaction. Warnings: what of tied pairs
    /// is not tied, curved sides that stay facets. Collective. @throws InputError on every rank where the bodies
    /// overlap too much, and where nothing of a tied pair is tied.
    std::vector<std::string> begin_contact(States &states, double t);
    /// Part of the interference of each pair that is pressed out at time @p t.
    std::vector<double> resolved_interference(double t) const;
    /// All that holds in @p increment: conditions, stabilisation, the part of interference fits. Collective.
    void impose(const Increment &increment);
    /// A second pass of these pairs, by number from 0 and with their clearances [length], on the same mesh. The state
    /// at hand is the one that the increment began with then; nothing of the new pairs touches in it. Collective.
    void add_second_passes(const std::vector<std::pair<unsigned int, double>> &passes, States &states);
    /// The state at hand becomes the one that the increment began with, and what refers to it follows. Collective.
    void roll_back(States &states);

    /// Young's modulus of each body [pressure].
    std::vector<double> stiffness() const;
    /// A copy of a fully distributed vector of displacements with ghost entries, which copies of it do not have.
    /// Collective.
    Vector with_ghosts(const Vector &v) const;
    /// "3 bodies, 120 cells, ...", and a line for each contact pair.
    std::vector<std::string> summary() const;

    Parameters                                 &parameters; ///< as given, but for second passes of contact pairs
    MPI_Comm                                    communicator;
    Bodies                                      bodies;
    std::unique_ptr<const dealii::Mapping<dim>> mapping;
    dealii::FESystem<dim>                       fe;
    dealii::DoFHandler<dim>                     dof_handler;
    dealii::IndexSet                            relevant;
    std::vector<std::unique_ptr<Material>>      materials;
    RigidBodies                                 rigid_bodies; ///< those that forces drive
    std::unique_ptr<BoundaryConditions>         boundary_conditions;
    std::unique_ptr<SolidAssembler>             solid;
    std::unique_ptr<ViscousStabilisation>       stabilisation;
    std::unique_ptr<ContactInterface>           contact;
    double length_scale  = 0.; ///< displacements are measured against this when the step moves nothing [length]
    double stiffest_cell = 0.; ///< size over degree of the cell with the largest modulus times size [length]

  private:
    void set_up_contact(State &now);
  };
} // namespace Nodus

#endif
