#ifndef nodus_contact_contact_fields_h
#define nodus_contact_contact_fields_h

#include <nodus/base/remedy.h>
#include <nodus/base/types.h>

#include <string>
#include <utility>
#include <vector>

namespace Nodus
{
  /// What users see of one contact pair, converged state: of the whole slave surface or of this rank's part.
  struct ContactFields
  {
    std::string name; ///< of the pair

    /// Slave surface: one entry per slave node of the pair; behind them nodes that hang, with area 0, which carry
    /// nothing of their own.
    std::vector<Point>         X;                ///< reference position
    std::vector<Vector3>       displacement;     ///<
    std::vector<double>        pressure;         ///< CPRESS = -lambda_bar >= 0 in compression [pressure]
    std::vector<double>        multiplier;       ///< lambda_j, the unknown itself [pressure]
    std::vector<double>        gap;              ///< COPEN = -d_n [length]
    std::vector<Vector3>       friction;         ///< friction traction on the slave, global axes [pressure]
    std::vector<double>        shear[2];         ///< CSHEAR1, CSHEAR2: friction in the tangent frame [pressure]
    std::vector<double>        slip[2];          ///< CSLIP1, CSLIP2: accumulated slip while in contact [length]
    std::vector<ContactStatus> status;           ///< CSTATUS: 0 open, 1 slip, 2 stick
    std::vector<Vector3>       normal, tangent1; ///< unit, from slave to master
    std::vector<double>        area;             ///< m_j [area]
    std::vector<char>          paired;           ///< 0: no master found
    std::vector<unsigned int>
        status_changes;                     ///< of the increment; integration point scheme: sum over the points around
    std::vector<unsigned int> cycle_period; ///< of the longest status cycle the node took part in; 0: none
    std::vector<char> contradiction;        ///< last one: 0 none, 1 tension, 2 penetration, 3 over cone, 4 against slip

    std::vector<DoFIndex> number; ///< of the slave node on the whole slave surface

    /// Slave faces: (degree+1)^2 indices into the arrays above, lexicographic (first local coordinate fastest).
    unsigned int                           degree;
    std::vector<std::vector<unsigned int>> faces;

    std::vector<DoFIndex> node; ///< number of each node on the whole mesh

    /// Adds node @p i of @p other.
    void append(const ContactFields &other, unsigned int i);
    /// Adds a node that hangs between others, given by place and weight.
    void interpolate(const std::vector<std::pair<unsigned int, double>> &others,
                     const Point                                        &X_hanging,
                     const Vector3                                      &u,
                     DoFIndex                                            number_hanging,
                     DoFIndex                                            node_hanging);

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &name &X &displacement &pressure &multiplier &gap &friction &shear[0] & shear[1] & slip[0] & slip[1] &
          status &normal &tangent1 &area &paired &status_changes &cycle_period &contradiction &number &node &degree
              &faces;
    }
  };

  /// Resultants and counts of one pair, for contact.csv; moments about the origin, current configuration.
  struct ContactResultants
  {
    std::string  name;
    Vector3      slave_force, slave_moment, master_force, master_moment;
    Vector3      friction; ///< part of the force on the slave
    double       contact_area = 0., maximum_pressure = 0.;
    unsigned int open = 0, slip = 0, stick = 0, unpaired = 0; ///< contact sites: nodes or integration points
    /// Status changes of the increment: all, by what contradicted the status (the four kinds), longest cycle.
    unsigned int status_changes = 0, contradictions[4] = {0, 0, 0, 0}, longest_cycle = 0;

    /// One of several bodies that are master: its part of the force on the master, and of the moment.
    struct OnMaster
    {
      unsigned int body; ///< number, from 1
      Vector3      force, moment;
    };
    std::vector<OnMaster> masters; ///< empty where there is one body, no mesh, or self-contact
  };

  /// Iterations spent on one increment.
  struct IterationCounts
  {
    unsigned int geometry = 0, threshold = 0, status = 0, newton = 0, krylov = 0;
    unsigned int cut_backs = 0;       ///< times that the increment was halved since the last one converged
    unsigned int fallbacks = 0;       ///< attempts that were given up for another one, and laws that were regularised
    PerRemedy<unsigned int> remedies; ///< how often each was used, in attempts that were given up, too
  };

  /// A rigid body that force and moment drive, since the start.
  struct RigidBodyMotion
  {
    std::string name;
    Vector3     translation; ///< of its rotation centre [length]
    Vector3     rotation;    ///< rotation vector, no longer than half a turn [radians]
    Vector3     force;       ///< on the body, but for contact and loads on its cells [force]
    Vector3     moment;      ///< of the same about its centre as it moves [force length]
  };

  /// The section of a bolt that a preload tightens.
  struct PreloadSection
  {
    std::string name;       ///< of its contact pair
    double      force;      ///< in the bolt along its axis, tension is positive [force]
    double      shortening; ///< of the bolt between the two faces of the section, since the start [length]
    Vector3     shear;      ///< what acts across the axis, on the slave side [force]
    bool        locked;     ///< the length is what has been reached, the force follows the loads
  };
} // namespace Nodus

#endif
