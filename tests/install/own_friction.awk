# Pressure and coefficient of friction at the end of contact.csv against those of contrib/examples/own_friction: the
# pressure at d_0 is 2 p_0 = 10; after a way of 0.09 the coefficient is 0.2 + 0.4 exp(-0.09/0.05).
NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i }
END {
  pressure = $column["slave force z [force]"]
  coefficient = -$column["slave force x [force]"] / pressure
  expected = 0.2 + 0.4 * exp(-1.8)
  printf "pressure %.8f, coefficient %.8f, expected 10 and %.8f\n", pressure, coefficient, expected
  exit !((pressure - 10) ^ 2 < 1e-10 && (coefficient - expected) ^ 2 < 1e-12)
}
