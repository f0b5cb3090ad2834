//! stub
#![allow(missing_docs)]
use crate::error::Result;
use crate::geometry::{Direction,Arc,exp};
use crate::lattice::Chain;
use crate::path::Path;
use crate::registry::{Described,family};
use crate::spins::Spins;
use crate::units::Angle;
use serde::Deserialize;
use rand::{RngExt,SeedableRng};
family!{
    /// g
    GuessSpec as FirstGuess { Geodesic(Geodesic), Sweep(Sweep) }
}
pub struct GuessContext<'a>{pub chain:&'a Chain,pub wall_width_sites:f64,pub default_axis:Direction}
pub trait FirstGuess{ fn path(&self,a:&Spins,b:&Spins,images:usize,c:&GuessContext)->Result<Path>; }
#[derive(Clone,Debug,PartialEq,Deserialize)] pub struct Geodesic{pub axis:Option<Direction>}
#[derive(Clone,Copy,Debug,PartialEq,Deserialize)] #[serde(rename_all="snake_case")] pub enum Edge{Left,Right,Center,Ends}
impl std::fmt::Display for Edge{fn fmt(&self,f:&mut std::fmt::Formatter)->std::fmt::Result{write!(f,"{self:?}")}}
#[derive(Clone,Debug,PartialEq,Deserialize)] pub struct Sweep{pub from:Edge,pub width:Option<f64>,pub axis:Option<Direction>}
#[derive(Clone,Debug,PartialEq,Deserialize)] pub struct NoiseSpec{pub amplitude:Angle,pub seed:u64}
impl Described for Geodesic{const NAME:&'static str="geodesic";const SUMMARY:&'static str="";const EXAMPLE:&'static str="";}
impl Described for Sweep{const NAME:&'static str="sweep";const SUMMARY:&'static str="";const EXAMPLE:&'static str="";}
fn clock(a:&Spins,b:&Spins,images:usize,axis:Direction,u:impl Fn(f64,usize)->f64)->Path{
    let arcs:Vec<Arc>=(0..a.sites()).map(|i|Arc::new(a.get(i),b.get(i),axis)).collect();
    let im:Vec<Spins>=(0..images).map(|k|{let t=k as f64/(images-1) as f64;Spins::from_vectors(&arcs.iter().enumerate().map(|(i,r)|r.at(u(t,i))).collect::<Vec<_>>()).unwrap()}).collect();
    Path::new(&im)
}
impl FirstGuess for Geodesic{fn path(&self,a:&Spins,b:&Spins,images:usize,c:&GuessContext)->Result<Path>{Ok(clock(a,b,images,self.axis.unwrap_or(c.default_axis),|t,_|t))}}
impl FirstGuess for Sweep{fn path(&self,a:&Spins,b:&Spins,images:usize,c:&GuessContext)->Result<Path>{
    let n=a.sites() as f64;let w=self.width.unwrap_or((4.0*c.wall_width_sites).clamp(2.0,n.max(2.0)));
    let key=|i:usize|{let x=i as f64+0.5;match self.from{Edge::Left=>x,Edge::Right=>n-x,Edge::Center=>(x-n/2.).abs(),Edge::Ends=>n/2.-(x-n/2.).abs()}};
    let l=(0..a.sites()).map(key).fold(0.0,f64::max)+0.5;
    Ok(clock(a,b,images,self.axis.unwrap_or(c.default_axis),|t,i|((t*(l+w)-key(i))/w).clamp(0.,1.)).resampled(images))}}
pub fn add_noise(p:&Path,s:&NoiseSpec,_:&Chain)->Path{
    let n=p.sites();let mut r=rand_chacha::ChaCha8Rng::seed_from_u64(s.seed);
    let mut coef=vec![];for _ in 0..5{for _ in 0..3{let x:f64=(0..12).map(|_|r.random_range(0.0..1.0f64)).sum::<f64>()-6.0;coef.push(x);}}
    let im:Vec<Spins>=(0..p.images()).map(|k|{let sp=p.spins(k);if k==0||k+1==p.images(){return sp;}
        let env=libm::sin(std::f64::consts::PI*k as f64/(p.images()-1) as f64);
        Spins::from_vectors(&(0..n).map(|i|{let x=(i as f64+0.5)/n as f64;let mut v=[0.0;3];for m in 0..5{for c in 0..3{v[c]+=s.amplitude.0*env*coef[3*m+c]*libm::cos(std::f64::consts::PI*m as f64*x);}}
            let q=sp.get(i);let d=v[0]*q[0]+v[1]*q[1]+v[2]*q[2];exp(q,[v[0]-d*q[0],v[1]-d*q[1],v[2]-d*q[2]])}).collect::<Vec<_>>()).unwrap()}).collect();
    Path::new(&im)}
pub fn smooth(p:&Path,_:f64)->Path{p.clone()}
