"""Does it stand? Contacts, the contact graph, and whether contact forces exist that hold a scene.

`features` are what a mesh touches others with, `contacts` finds contact points, `mass` weighs,
`equilibrium` looks for forces, and `support` answers the questions of body rules. Nothing here is
imported unless a rule asks.
"""
