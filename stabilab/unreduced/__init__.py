"""Motions that no orbit serves: endless growth by law, torques between equal axes, free gyrostats, torques
off the axes, bounds."""
