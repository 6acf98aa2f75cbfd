#ifndef nodus_tests_paraboloid_h
#define nodus_tests_paraboloid_h

#include "../cases.h"

namespace Cases
{
  /// A paraboloid (z = r^2/16, 6 cells an edge; a quarter of it) that is pressed into a block by @p depth at t = 1.
  inline Parameters paraboloid_on_block(const std::string &depth)
  {
    Parameters p;
    for (const unsigned int volume : {1, 2})
    {
      BodyParameters body;
      body.mesh_file               = SOURCE_DIR "/../meshes/paraboloid.msh";
      body.volume_ids              = {volume};
      body.material.law            = MaterialParameters::Law::linear_elastic;
      body.material.youngs_modulus = 1000;
      body.material.poissons_ratio = 0.3;
      p.bodies.push_back(body);
    }
    p.boundary_conditions = {hold("x", region(0, {10, 16}), {0}),
                             hold("y", region(0, {12, 18}), {1}),
                             hold("bottom", region(2, {20}), {0, 1, 2}),
                             drive("top", region(1, {15}), 2, "-" + depth + "*t")};
    p.contact_pairs       = {pair(region(1, {14}), region(2, {21}))};
    p.output.write_vtu    = false;
    return p;
  }
} // namespace Cases

#endif
