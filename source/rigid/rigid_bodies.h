#ifndef nodus_rigid_rigid_bodies_h
#define nodus_rigid_rigid_bodies_h

#include "mesh/bodies.h"
#include "rigid/prescribed_motion.h"
#include <nodus/base/types.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// The rigid bodies with a mesh that forces and moments drive: those with free components. The motion of each has six
  /// components about global axes, translation of its centre and rotation about it: x = c + T + R (X - c).
  ///
  /// Behind them stand the coupled faces of deformable bodies: the nodes of each move as those of a rigid body, in some
  /// components or all. Behind those the preloaded sections of bolts, each of which has the first component alone: by
  /// how much the bolt is shortened there, along an axis of its own. The axial force drives it, or it is locked.
  ///
  /// The unknowns of an increment are T and the rotation vector theta of the increment, R = exp(theta) R_begin; those
  /// that are not free follow the prescribed motion, theta the increment of its rotation vector. Every rank holds all
  /// of it.
  class RigidBodies
  {
  public:
    static constexpr unsigned int n_components = 2 * dim;
    using Components                           = std::array<double, n_components>;

    /// Motion of a body: what is left of the past, and the unknowns of the increment.
    struct State
    {
      Vector3                translation; ///< of the centre, now; of a section the first component is its shortening
      Vector3                turn;        ///< theta, rotation vector since the increment began
      dealii::Tensor<2, dim> rotation = dealii::unit_symmetric_tensor<dim>(); ///< R_begin
      Vector3                prescribed_rotation; ///< rotation vector of the prescribed motion as the increment begins
      Components             applied{}; ///< forces and moments then, also those that hold prescribed components
      Components             motion{};  ///< translation and rotation vector of the last increment

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &translation &turn &rotation &prescribed_rotation;
        for (Components *const components : {&applied, &motion})
          for (double &value : *components)
            archive &value;
      }
    };

    /// @p now, one for each driven body, and @p begin, as the increment began, outlive the object, which moves the
    /// first ones; they are set to those at rest. @throws InputError on every rank where an expression does not parse.
    RigidBodies(const std::vector<BodyParameters>              &parameters,
                const std::vector<BoundaryConditionParameters> &conditions,
                const std::vector<ContactPairParameters>       &pairs,
                const Bodies                                   &bodies,
                std::vector<State>                             &now,
                std::vector<State>                             &begin);

    unsigned int size() const
    {
      return bodies_.size();
    }
    /// Whether it is a rigid body, a coupled face, or the section of a bolt.
    bool is_body(const unsigned int i) const
    {
      return !is_face(i) && !is_section(i);
    }
    bool is_face(const unsigned int i) const
    {
      return bodies_[i].face != nullptr;
    }
    bool is_section(const unsigned int i) const
    {
      return bodies_[i].section != nullptr;
    }
    bool has_faces() const;
    /// Number, from 0, of the contact pair that a section is; and of each pair which of these it is, or an invalid
    /// number.
    unsigned int pair(const unsigned int i) const
    {
      return bodies_[i].pair;
    }
    std::vector<unsigned int> sections() const;
    /// Out of the slave side of a section, of length 1; zero for the others.
    const Vector3 &axis(const unsigned int i) const
    {
      return bodies_[i].axis;
    }
    /// By how much of its axis a section is shortened, of all that is driven; zero for the others [length].
    std::vector<Vector3> shortenings(bool as_the_increment_began = false) const;
    /// Index of a driven one, or of the body that a face or section belongs to, among all bodies.
    unsigned int body(const unsigned int i) const
    {
      return bodies_[i].number;
    }
    const std::string &name(const unsigned int i) const
    {
      return bodies_[i].name;
    }
    /// "rigid body 2 (punch)", for messages.
    std::string title(unsigned int i) const;
    bool        is_free(const unsigned int i, const unsigned int component) const
    {
      return bodies_[i].free[component];
    }
    /// Half of the diagonal of its box [length].
    double extent(const unsigned int i) const
    {
      return bodies_[i].extent;
    }

    /// What is at node @p i of this rank: its first degree of freedom and its reference position.
    struct Node
    {
      DoFIndex dof;
      Point    X;
    };
    /// Its owned nodes on the mesh as it is, of a face without hanging ones.
    const std::vector<Node> &nodes(const unsigned int i) const
    {
      return bodies_[i].nodes;
    }
    /// Whether its nodes follow it in direction @p c.
    bool moves(const unsigned int i, const unsigned int c) const
    {
      return bodies_[i].moves[c];
    }
    /// The owned degrees of freedom that follow coupled faces.
    std::vector<DoFIndex> coupled() const;
    /// From its centre to one of its nodes, as they are now.
    Vector3 arm(unsigned int i, const Node &node) const;
    /// Adds to six @p sums, force and moment, what a force at a node, @p arm away from the centre, does to it.
    void add_force(unsigned int i, const Vector3 &arm, const Vector3 &force, double *sums) const;
    /// Once the mesh is new; the axes of sections are those of the first one. @throws InputError on every rank where a
    /// section has none.
    void find_nodes(const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping);

    /// Loads and prescribed components are those of time @p t from here. @throws InputError on every rank
    void set_time(double t);

    /// Force and moment about the centre, zero where prescribed.
    const Components &load(const unsigned int i) const
    {
      return bodies_[i].load;
    }
    /// Where the centre is now.
    Point centre(const unsigned int i) const
    {
      return Point(bodies_[i].centre + now_[i].translation);
    }
    /// What the unknowns still lack of the prescribed values, zero at free components.
    Components missing(unsigned int i) const;
    /// The spin of R by a variation of theta: delta R = [spin delta theta]x R (eq. R2).
    dealii::Tensor<2, dim> spin(unsigned int i) const;

    /// unknowns += factor * correction, six of each body. @throws SolverFailure where a body turns by more than half
    /// a turn in the increment.
    void advance(double factor, const std::vector<double> &correction);
    /// Sets the displacements of the nodes, owned ones, and of what hangs on coupled faces. Collective.
    void move(Vector &u) const;

    /// What has been moved since the states @p before is what go_on() goes on along.
    void keep_motion(const std::vector<State> &before);
    /// Free components move by @p part of that, the others to their prescribed values. @throws SolverFailure like
    /// advance().
    void go_on(double part);

    /// The increment ends here with the forces and moments @p applied to each body: the next one begins.
    void end_increment(const std::vector<Components> &applied);

    /// Work of the mean of the forces and moments at both ends of the increment in it [energy]: @p before, and
    /// @p applied at its end, which has not been ended yet.
    double work(const std::vector<State> &before, const std::vector<Components> &applied) const;
    /// Of the centre from the start.
    const Vector3 &translation(const unsigned int i) const
    {
      return now_[i].translation;
    }
    /// Rotation vector from the start, no longer than half a turn [radians].
    Vector3 rotation(unsigned int i) const;

  private:
    struct Body
    {
      unsigned int                                     number;
      std::string                                      name, label;
      const BoundaryConditionParameters               *face    = nullptr; ///< null: the whole body, or a section
      const ContactPairParameters                     *section = nullptr;
      unsigned int                                     pair    = 0; ///< number of that, from 0
      Vector3                                          axis;        ///< of the section
      std::array<bool, n_components>                   free{};
      std::array<bool, dim>                            moves{{true, true, true}};
      double                                           extent;
      Point                                            centre; ///< at the start
      std::unique_ptr<const PrescribedMotion>          motion;
      std::unique_ptr<const dealii::FunctionParser<1>> loads;
      std::vector<Node>                                nodes;
      Components                                       load{};
      Vector3                                          prescribed_translation, prescribed_rotation; ///< at the time set
    };
    /// What drives a body: expressions of force and moment, and the motion of the other components.
    void add(Body                              body,
             const PrescribedMotionParameters &motion,
             const std::vector<unsigned int>  &free,
             std::vector<std::string>          force,
             const std::vector<std::string>   &moment);
    void find_axis(Body &section, const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping);
    /// Where it is: R of x = c + T + R (X - c).
    dealii::Tensor<2, dim> turned(unsigned int i) const;

    const Bodies                     &all_;
    std::vector<Body>                 bodies_;
    std::vector<State>               &now_;
    const std::vector<State>         &begin_;
    const unsigned int                n_pairs_;
    dealii::AffineConstraints<double> hanging_; ///< where there are coupled faces: their neighbours follow
  };
} // namespace Nodus

#endif
