#ifndef nodus_output_energies_h
#define nodus_output_energies_h

namespace Nodus
{
  /// Energies of all bodies since the start (eqs. E2 and E3) [energy]: a quasi-static balance, so that
  /// external + released + contact = stored + friction + plastic up to what finite increments leave.
  ///
  /// Works are those of the mean of the forces at both ends of an increment (trapezoidal rule). Friction is dissipated
  /// by the forces at its end, as the law that is solved says: never negative where they oppose the slip.
  struct Energies
  {
    double external = 0.; ///< work of loads and of reactions at prescribed displacements
    double released = 0.; ///< work of the reactions that go to zero after their condition has ceased to act
    double contact  = 0.; ///< work of contact pressures on the bodies: of those whose gap closes or opens meanwhile
    double stored   = 0.; ///< in the bodies and in springs
    double friction = 0.; ///< dissipated by friction
    double plastic  = 0.; ///< dissipated by plastic flow
    double stabilisation = 0.; ///< dissipated by viscous stabilisation
    double unresolved    = 0.; ///< what tolerances and round-off may take from the balance

    double imbalance() const
    {
      return external + released + contact - stored - friction - plastic - stabilisation;
    }
    /// What came in and went where, as a scale.
    double throughput() const;

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &external &released &contact &stored &friction &plastic &stabilisation &unresolved;
    }
  };
} // namespace Nodus

#endif
