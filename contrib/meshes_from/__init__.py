"""Meshes of other programs as gmsh files of hexahedra for nodus: see contrib/convert and contrib/doc/meshes.md."""
