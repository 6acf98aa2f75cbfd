#ifndef nodus_contact_jump_operator_h
#define nodus_contact_jump_operator_h

#include <nodus/contact/pairing.h>
#include <nodus/contact/surface.h>

#include <vector>

namespace Nodus
{
  /// G: the jump of each slave node as a combination of nodal values, slave minus master (eq. 22).
  class JumpOperator
  {
  public:
    struct Entry
    {
      unsigned int node;   ///< index into ContactSurfaces::nodes()
      double       weight; ///< 1 for the slave node, -phi'_k for master nodes
    };

    /// Collocated jump: the slave node against the master shape functions at its projection. Unpaired nodes have no
    /// entry.
    void build_nodal(const ContactSurfaces &surfaces, const Pairing &pairing);

    const Entry *begin(const unsigned int slave) const
    {
      return entries_.data() + start_[slave];
    }
    const Entry *end(const unsigned int slave) const
    {
      return entries_.data() + start_[slave + 1];
    }

    /// Jump of a nodal vector field (or of positions) at a slave node.
    template <typename T>
    Vector3 jump(const unsigned int slave, const std::vector<T> &field) const
    {
      Vector3 result;
      for (const Entry *e = begin(slave); e != end(slave); ++e)
        result += e->weight * field[e->node];
      return result;
    }

  private:
    std::vector<Entry>        entries_;
    std::vector<unsigned int> start_;
  };
} // namespace Nodus

#endif
