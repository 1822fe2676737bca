"""The coupon: a test sheet whose ladders show which figures suit a material on a machine.

``make`` plans it as a job like any other; ``answers`` and ``record`` turn what a person read from
it into a tested preset and a measured machine.
"""
