"""Motions of many turns: the band that they fill, and the moment that matters in their time."""
